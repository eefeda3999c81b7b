#pragma once

#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/driving/track_kinematics.h"

namespace arfm_vo {

/// How far a sighting may be from what the tracks predict.
struct PoseConsistencyOptions {
  double max_error_m = 0.1;     ///< without slip and with a certain pose
  double max_error_rad = 0.15;  ///< the same of the heading
  double max_slip_ratio = 1;    ///< adds this share of the tracks' way; slip has a watch of its own
  double max_sideways_ratio = 0.3;  ///< the same across the way
  double num_sigmas = 3;            ///< of the pose's covariance that is added
  double max_uncertain_m = 0.3;     ///< what covariance may add at most
  double max_uncertain_rad = 0.3;   ///< the same of the heading
  double max_map_step_m = 0.25;     ///< of map -> odom at the rover, since a goal or a start
  double max_map_turn_rad = 0.1;    ///< the same of the heading
  /// Sightings so far apart in time are compared too: the rover slides where they disagree.
  double slide_window_s = 3;

  void Check() const;
  ARFM_FIELDS(max_error_m, max_error_rad, max_slip_ratio, max_sideways_ratio, num_sigmas,
              max_uncertain_m, max_uncertain_rad, max_map_step_m, max_map_turn_rad, slide_window_s)
};

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
  PoseConsistency(const PoseConsistencyOptions& options, const TrackKinematics& kinematics);

  /// The pose that the tracks predict from `sighting` once their ways are `ways`.
  RoverPose Predict(const TrackedSighting& sighting, const TrackWays& ways) const;

  /// `later` against its prediction from `earlier`, which is of the same epoch.
  PoseDifference Compare(const TrackedSighting& earlier, const TrackedSighting& later) const;

  /// The step of the rover's place in the map where map -> odom changes, `before` to `after`, and
  /// the odometry is as sure as at `agreed` and `now`.
  PoseDifference MapStep(const RoverPose& before, const RoverPose& after,
                         const TrackedSighting& agreed, const TrackedSighting& now) const;

  const PoseConsistencyOptions& options() const { return options_; }

 private:
  PoseConsistencyOptions options_;
  TrackKinematics kinematics_;
};

}  // namespace arfm_vo
