#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace arfm_vo {

/// A rigid motion. Named `b_from_a`: it takes coordinates in frame a to coordinates in frame b,
/// x_in_b = b_from_a * x_in_a, so that names cancel: c_from_a = c_from_b * b_from_a.
struct Rigid3 {
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Rigid3() = default;
  Rigid3(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
      : rotation(rotation), translation(translation) {}
  Rigid3(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation)
      : rotation(Eigen::Quaterniond(rotation).normalized()), translation(translation) {}

  Rigid3 Inverse() const {
    const Eigen::Quaterniond inverse = rotation.conjugate();
    return {inverse, Eigen::Vector3d(-(inverse * translation))};
  }
  Eigen::Matrix3d RotationMatrix() const { return rotation.toRotationMatrix(); }
  /// [3 x 4] matrix [R | t], as the KITTI pose files hold it.
  Eigen::Matrix<double, 3, 4> Matrix() const {
    Eigen::Matrix<double, 3, 4> matrix;
    matrix << RotationMatrix(), translation;
    return matrix;
  }
  /// Angle of the rotation in [0, pi] rad.
  double Angle() const { return 2 * std::atan2(rotation.vec().norm(), std::abs(rotation.w())); }
  bool IsIdentity() const { return rotation.vec().isZero(0) && translation.isZero(0); }
  bool IsFinite() const { return rotation.coeffs().allFinite() && translation.allFinite(); }
};

inline Rigid3 operator*(const Rigid3& c_from_b, const Rigid3& b_from_a) {
  return {(c_from_b.rotation * b_from_a.rotation).normalized(),
          Eigen::Vector3d(c_from_b.rotation * b_from_a.translation + c_from_b.translation)};
}

inline Eigen::Vector3d operator*(const Rigid3& b_from_a, const Eigen::Vector3d& x_in_a) {
  return b_from_a.rotation * x_in_a + b_from_a.translation;
}

/// The motion `part` of the way from `first` (0) to `second` (1): rotation by slerp, translation
/// straight.
inline Rigid3 Interpolate(const Rigid3& first, const Rigid3& second, double part) {
  return {first.rotation.slerp(part, second.rotation),
          Eigen::Vector3d((1 - part) * first.translation + part * second.translation)};
}

/// The unit quaternion of the rotation vector `omega` (rad).
inline Eigen::Quaterniond ExpSO3(const Eigen::Vector3d& omega) {
  const double angle = omega.norm();
  const double half_sinc = angle < 1e-9 ? 0.5 : std::sin(angle / 2) / angle;
  Eigen::Quaterniond q;
  q.w() = std::cos(angle / 2);
  q.vec() = half_sinc * omega;
  return q.normalized();
}

/// The rotation vector (rad, norm in [0, pi]) of a unit quaternion; inverse of ExpSO3.
inline Eigen::Vector3d LogSO3(const Eigen::Quaterniond& q) {
  const double sign = q.w() < 0 ? -1 : 1;
  const double sine = q.vec().norm();
  const double angle = 2 * std::atan2(sine, sign * q.w());
  const double scale = sine < 1e-12 ? 2.0 : angle / sine;
  return sign * scale * q.vec();
}

/// The cross-product matrix: Skew(a) * b = a x b.
inline Eigen::Matrix3d Skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

/// The project's one tangent step for poses: `delta` = (rotation vector, translation) in frame b,
/// applied from the left,
///   rotation <- Exp(delta[0:3]) * rotation,  translation <- Exp(delta[0:3]) * translation +
///   delta[3:6].
inline Rigid3 BoxPlus(const Rigid3& b_from_a, const Eigen::Matrix<double, 6, 1>& delta) {
  return Rigid3(ExpSO3(delta.head<3>()), Eigen::Vector3d(delta.tail<3>())) * b_from_a;
}

}  // namespace arfm_vo
