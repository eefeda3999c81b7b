#include "arfm_vo/pose/reprojection.h"

#include <Eigen/LU>

namespace arfm_vo {

Eigen::Matrix3d ReprojectionInformation(const StereoCamera& camera,
                                        const PointObservation& observation,
                                        const Eigen::Matrix3d& rotation_camera_from_world,
                                        const Eigen::Vector3d& x_in_camera) {
  const double variance = observation.sigma_px * observation.sigma_px;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  if (observation.x_covariance.isZero(0)) {
    information.diagonal().head(observation.NumCoordinates()).setConstant(1 / variance);
    return information;
  }
  const Eigen::Matrix3d jacobian =
      ProjectionJacobian(camera, x_in_camera) * rotation_camera_from_world;
  Eigen::Matrix3d covariance = jacobian * observation.x_covariance * jacobian.transpose();
  covariance.diagonal().array() += variance;
  if (observation.has_right) return covariance.inverse();
  information.topLeftCorner<2, 2>() = covariance.topLeftCorner<2, 2>().inverse();
  return information;
}

}  // namespace arfm_vo
