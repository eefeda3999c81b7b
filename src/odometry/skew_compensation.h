#pragma once

#include <optional>

#include "arfm_vo/odometry/eye_skew.h"
#include "arfm_vo/odometry/odometry_update.h"

namespace arfm_vo {

/// Learns how much later the right picture of each pair is taken than the left one, and how the
/// camera moves in between.
class SkewCompensation {
 public:
  explicit SkewCompensation(const StereoCamera& camera) : skew_(camera) {}

  /// Takes the next pair, with the pose that is expected for it.
  void Advance(double stamp_s, const std::optional<Rigid3>& predicted) {
    later_from_now_ = skew_.MotionBetweenEyes(stamp_s, predicted);
  }
  /// The camera's motion between the pair's two pictures.
  const Rigid3& later_from_now() const { return later_from_now_; }

  /// Learns from the pair's pose, which is degraded where the motion is too large to be made up
  /// for well. Returns by how much the way up to here may be wrong besides, m: that of all before
  /// the skew was found.
  double Learn(const LocalMap& map, OdometryUpdate& update);
  /// The next pair does not follow this one.
  void Interrupt() { skew_.Interrupt(); }

 private:
  EyeSkewEstimator skew_;
  bool is_found_ = false;
  Rigid3 later_from_now_;
};

}  // namespace arfm_vo
