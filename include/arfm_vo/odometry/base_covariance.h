#pragma once

#include <Eigen/Core>
#include <optional>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Twist = Eigen::Matrix<double, 6, 1>;  ///< seen from the base: (m/s, rad/s)

/// Of a base that went from one pose to the other at an even speed; nothing where that took no
/// time.
inline std::optional<Twist> TwistBetween(const Rigid3& odom_from_before,
                                         const Rigid3& odom_from_now, double interval_s) {
  if (interval_s <= 0) return std::nullopt;
  const Rigid3 motion = odom_from_before.Inverse() * odom_from_now;
  Twist twist;
  twist << motion.translation / interval_s, LogSO3(motion.rotation) / interval_s;
  return twist;
}

/// On the diagonal where nothing is known: large, yet finite (1e308 makes rviz fall over).
constexpr double kUnknownVariance = 9999;

/// The base's covariance (x, y, z m, rotations about x, y, z rad), seen from the base, of a camera
/// pose with the covariance that PoseEstimate has: (rotation rad, translation m), camera frame.
Matrix6 BaseCovariance(const Matrix6& camera_covariance, const Rigid3& base_from_camera);

/// Covariance (of DriftCovariance) of how far a base may be from where `twist` would have brought
/// it without a picture: it may stop, or go twice as fast, within a second. Where its speed was
/// never seen it may have any that a vehicle has.
Matrix6 GapCovariance(const std::optional<Twist>& twist, double gap_s);

/// How sure the odometry is of where the base stands in odom, over worlds that follow one another:
/// what was unsure when a world began stays, and an unsure heading makes the place unsure with the
/// way.
class DriftCovariance {
 public:
  /// Covariance (x, y, z, rotations about the axes of odom) of a pose that has `base_covariance`
  /// (BaseCovariance) in its world.
  Matrix6 At(const Rigid3& odom_from_base, const Matrix6& base_covariance) const;

  /// A world begins at a pose that had `covariance` in odom, after a gap of `gap_covariance` (both
  /// as of At).
  void StartEpoch(const Rigid3& odom_from_base, const Matrix6& covariance,
                  const Matrix6& gap_covariance);

 private:
  Rigid3 odom_from_start_;
  Matrix6 covariance_ = Matrix6::Zero();  // where this world began, axes of odom
};

}  // namespace arfm_vo
