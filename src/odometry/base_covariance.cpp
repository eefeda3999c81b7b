#include "arfm_vo/odometry/base_covariance.h"

#include <algorithm>

namespace arfm_vo {

Matrix6 BaseCovariance(const Matrix6& camera_covariance, const Rigid3& base_from_camera) {
  // A step (w, t) of the camera is, for a base at the other end of the lever p, the step
  // (R w, R t + p x R w).
  const Eigen::Matrix3d rotation = base_from_camera.RotationMatrix();
  Matrix6 base_from_step = Matrix6::Zero();
  base_from_step.topLeftCorner<3, 3>() = Skew(base_from_camera.translation) * rotation;
  base_from_step.topRightCorner<3, 3>() = rotation;
  base_from_step.bottomLeftCorner<3, 3>() = rotation;
  return base_from_step * camera_covariance * base_from_step.transpose();
}

Matrix6 GapCovariance(const std::optional<Twist>& twist, double gap_s) {
  // A base that stood may have begun to move as fast.
  constexpr double kFromRest_m_s = 0.1, kFromRest_rad_s = 0.1;
  constexpr double kUnknown_m_s = 5, kUnknown_rad_s = 1;
  const double change = std::min(gap_s, 1.0);
  const double speed_m_s = twist ? twist->head<3>().norm() * change + kFromRest_m_s : kUnknown_m_s;
  const double turn_rad_s =
      twist ? twist->tail<3>().norm() * change + kFromRest_rad_s : kUnknown_rad_s;
  const double way_m = speed_m_s * gap_s, turn_rad = turn_rad_s * gap_s;
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(way_m * way_m),
      Eigen::Vector3d::Constant(turn_rad * turn_rad);
  return covariance;
}

Matrix6 DriftCovariance::At(const Rigid3& odom_from_base, const Matrix6& base_covariance) const {
  Matrix6 carried = Matrix6::Identity();
  carried.topRightCorner<3, 3>() = -Skew(odom_from_base.translation - odom_from_start_.translation);
  Matrix6 turned = Matrix6::Zero();
  turned.topLeftCorner<3, 3>() = odom_from_base.RotationMatrix();
  turned.bottomRightCorner<3, 3>() = odom_from_base.RotationMatrix();
  return carried * covariance_ * carried.transpose() +
         turned * base_covariance * turned.transpose();
}

void DriftCovariance::StartEpoch(const Rigid3& odom_from_base, const Matrix6& covariance,
                                 const Matrix6& gap_covariance) {
  covariance_ = covariance + gap_covariance;
  odom_from_start_ = odom_from_base;
}

}  // namespace arfm_vo
