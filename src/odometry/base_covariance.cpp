#include "arfm_vo/odometry/base_covariance.h"

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
