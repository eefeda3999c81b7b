#pragma once

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/odometry/base_covariance.h"

namespace arfm_vo {

/// A map begun after a loss may have begun on what moves: on the object that hid the ground. A base
/// that goes on in it as it went before has the ground in view; what has changed its motion within
/// the loss may be the base or what it looks at.
class NewMapDoubt {
 public:
  /// A map begins at `odom_from_base`; the base had `twist_before` (m/s, rad/s).
  NewMapDoubt(double stamp_s, const Rigid3& odom_from_base, const Twist& twist_before);

  /// Takes a pose in the new map. Returns whether the base moves otherwise than before.
  bool Follow(double stamp_s, const Rigid3& odom_from_base);
  /// Whether nothing more can be told.
  bool IsOver() const { return is_over_; }
  /// Where the map began.
  const Rigid3& odom_from_start() const { return odom_from_start_; }

 private:
  double stamp_s_;
  Rigid3 odom_from_start_;
  Twist twist_before_;
  bool is_over_ = false;
};

}  // namespace arfm_vo
