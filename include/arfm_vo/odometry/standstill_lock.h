#pragma once

#include <optional>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/mapping/landmark.h"
#include "arfm_vo/pose/pose_estimate.h"

namespace arfm_vo {

struct StandstillOptions {
  bool enabled = true;                ///< hold the pose of a rover that stands
  double max_point_shift_px = 0.6;    ///< a point moved less than this may be at rest
  double min_resting_fraction = 0.6;  ///< of the shared points; the rest may be a moving shadow
  double max_significance = 6;        ///< of the motion, in its standard deviations
  double max_translation_m = 0.02;    ///< more is a motion, however uncertain
  double max_rotation_rad = 0.002;    ///< the same of the rotation

  void Check() const;
  ARFM_FIELDS(enabled)
};

/// Keeps the pose of a parked rover from walking: as long as most points stay where they were in
/// the frame in which it stopped, and the motion since is no more than noise, the pose is that
/// frame's. Creeping is not lost: the comparison is
/// with that one frame, so that small motions add up until they show.
class StandstillLock {
 public:
  explicit StandstillLock(const StandstillOptions& options);

  /// The pose to hold, where the camera has not moved; otherwise nothing, and this frame is what
  /// the next ones are compared with. `observations` are sorted by landmark.
  std::optional<Rigid3> Hold(const PoseEstimate& pose, const LandmarkObservations& observations);

  void Reset() { anchor_.clear(); }

 private:
  bool PointsRest(const LandmarkObservations& observations) const;
  bool MotionIsNoise(const PoseEstimate& pose) const;

  StandstillOptions options_;
  LandmarkObservations anchor_;
  Rigid3 anchor_pose_;  ///< camera_from_world
};

}  // namespace arfm_vo
