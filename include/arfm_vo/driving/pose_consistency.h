#pragma once

#include <string>

#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/driving/track_kinematics.h"

namespace arfm_vo {

// How far a sighting may be from what the tracks predict, without slip and with a certain pose: the
// place, and for each metre that the faster track has gone so much more (slip has a watch of its
// own).
constexpr double kMaxPoseError_m = 0.1, kMaxSlipRatio = 1;
/// By how much map -> odom may move the rover since a goal or a start.
constexpr double kMaxMapStep_m = 0.25;
/// Sightings so far apart in time are compared too: the rover slides where they disagree.
constexpr double kSlideWindow_s = 3;

/// A pose by sight in the odom frame, its standard deviations, and the ways of the tracks when it
/// was taken.
struct TrackedSighting {
  double taken_s = 0;
  RoverPose pose;
  double position_sigma_m = 0;
  double heading_sigma_rad = 0;
  TrackWays ways;
};

/// By how much two places differ, and by how much they may.
struct PoseDifference {
  double distance_m = 0, max_distance_m = 0;
  double sideways_m = 0, max_sideways_m = 0;  ///< of it, across the way
  double turn_rad = 0, max_turn_rad = 0;

  bool IsExcessive() const {
    return !(distance_m <= max_distance_m && sideways_m <= max_sideways_m &&
             turn_rad <= max_turn_rad);
  }
  /// "0.52 m (allowed 0.10 m), sideways 0.50 m (0.10 m), 3 deg (9 deg)".
  std::string ToString() const;
};

/// Compares what the rover sees of its way with what its tracks say.
class PoseConsistency {
 public:
  explicit PoseConsistency(const TrackKinematics& kinematics) : kinematics_(kinematics) {}

  /// The pose that the tracks predict from `sighting` once their ways are `ways`.
  RoverPose Predict(const TrackedSighting& sighting, const TrackWays& ways) const;

  /// `later` against its prediction from `earlier`, which is of the same epoch.
  PoseDifference Compare(const TrackedSighting& earlier, const TrackedSighting& later) const;

  /// The step of the rover's place in the map where map -> odom changes, `before` to `after`, and
  /// the odometry is as sure as at `agreed` and `now`.
  PoseDifference MapStep(const RoverPose& before, const RoverPose& after,
                         const TrackedSighting& agreed, const TrackedSighting& now) const;

 private:
  TrackKinematics kinematics_;
};

}  // namespace arfm_vo
