#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/drive_state.h"
#include "arfm_vo/driving/pose_consistency.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

struct PoseWatchOptions {
  double max_pose_age_s = 1.0;          ///< an older pose is stale: pause
  double max_position_sigma_m = 2.0;    ///< of the way driven since the start or the last datum
  double max_heading_sigma_rad = 0.35;  ///< the same of the heading
  double max_tilt_deg = 25;  ///< of the base against the map's z axis; above it the rover stops

  void Check() const;
  ARFM_FIELDS(max_pose_age_s, max_position_sigma_m, max_heading_sigma_rad, max_tilt_deg)
};

/// A pose by sight. Times are those of the driving clock, which never jumps.
struct PoseObservation {
  double taken_s = 0;  ///< when its images were taken
  Rigid3 odom_from_base;
  Rigid3 map_from_odom;

  Rigid3 MapFromBase() const { return map_from_odom * odom_from_base; }
};

/// How good the pose is, standard deviations.
struct PoseUncertainty {
  double taken_s = 0;
  double position_sigma_m = 0;
  double heading_sigma_rad = 0;
};

/// Judges whether the pose is good enough to drive by. A sighting counts once its covariance has
/// come and it has been compared with the tracks.
class PoseWatch {
 public:
  PoseWatch(const PoseWatchOptions& options, const TrackKinematics& kinematics);

  /// What tf tells now; the same sighting may be told again, with another map_from_odom.
  void Observe(double now_s, const PoseObservation& pose);
  /// There is no pose now, for `reason`.
  void ObserveNone(StopReason reason) { flaw_ = reason; }
  /// Says whether it was taken: one from the future is not.
  bool Observe(double now_s, const PoseUncertainty& uncertainty);
  /// The odometry's epoch, told with a pair taken at `taken_s`. Says whether it is another than
  /// before; then all that was seen is forgotten, and no sighting from before the pair counts.
  bool ObserveEpoch(uint32_t epoch, double taken_s);

  /// Takes the newest sighting. Returns how it contradicts the tracks (kPoseContradiction,
  /// kSliding) or the map that was agreed on (kMapStep); it is then what the next is compared with.
  std::optional<Fault> Judge(double now_s, const TrackHistory& tracks);

  /// Somebody plans by the map as it is told now: map -> odom may change from here on by a step and
  /// what the odometry has become less sure of, however slowly.
  void AgreeOnMap();

  /// What is wrong with the pose; nothing where the rover may drive by it.
  std::optional<StopReason> FindFault(double now_s) const;

  /// A person has confirmed the pose in the map that is told now, good or not: its uncertainty
  /// counts from here. Returns the pose; nothing where there is none or the odometry is lost.
  std::optional<RoverPose> SetDatum();

  bool HasPose() const { return !sightings_.empty(); }
  /// The last sighting that was judged; it may be old. HasPose must hold.
  const TrackedSighting& LastSighting() const { return sightings_.back(); }
  /// The same in full, odom_from_base.
  const Rigid3& LastSightingInOdom() const { return last_odom_from_base_; }
  /// The pose in the map that the tracks predict from the last sighting. HasPose must hold.
  RoverPose PredictInMap(const TrackWays& ways) const;
  bool IsTilted() const { return Tilt() > options_.max_tilt_deg * M_PI / 180; }
  bool IsTiltNearLimit() const { return Tilt() > 0.8 * options_.max_tilt_deg * M_PI / 180; }

 private:
  bool IsUncertain(double now_s) const;
  /// Of the last sighting, in the map that is told now.
  double Tilt() const { return TiltOf(map_from_odom_ * last_odom_from_base_); }
  std::optional<Fault> CompareWithTracks(const TrackedSighting& sighting) const;
  std::optional<Fault> TakeMap(const Rigid3& map_from_odom);
  void Keep(const TrackedSighting& sighting);

  PoseWatchOptions options_;
  PoseConsistency consistency_;
  std::optional<StopReason> flaw_ = StopReason::kPoseMissing;
  std::optional<PoseObservation> told_;
  std::optional<PoseUncertainty> uncertainty_, datum_;
  std::optional<uint32_t> epoch_;
  std::optional<double> epoch_start_s_;    // where the epoch has changed
  std::deque<TrackedSighting> sightings_;  // judged, of the last slide_window_s
  Rigid3 map_from_odom_, last_odom_from_base_, agreed_map_from_odom_;
  TrackedSighting agreed_;
};

}  // namespace arfm_vo
