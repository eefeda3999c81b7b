#pragma once

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// [6 x 6] the step of BoxPlus(b_from_world, .) by that of a_from_world with b_from_a exact.
inline Eigen::Matrix<double, 6, 6> CarryStep(const Rigid3& b_from_a) {
  const Eigen::Matrix3d rotation = b_from_a.RotationMatrix();
  Eigen::Matrix<double, 6, 6> carried = Eigen::Matrix<double, 6, 6>::Zero();
  carried.topLeftCorner<3, 3>() = rotation;
  carried.bottomRightCorner<3, 3>() = rotation;
  carried.bottomLeftCorner<3, 3>() = Skew(b_from_a.translation) * rotation;
  return carried;
}

/// `covariance` of a pose a_from_world as that of b_from_world = b_from_a * a_from_world with
/// b_from_a exact.
inline Eigen::Matrix<double, 6, 6> CarryCovariance(const Rigid3& b_from_a,
                                                   const Eigen::Matrix<double, 6, 6>& covariance) {
  const Eigen::Matrix<double, 6, 6> carried = CarryStep(b_from_a);
  return carried * covariance * carried.transpose();
}

}  // namespace arfm_vo
