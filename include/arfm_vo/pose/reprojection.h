#pragma once

#include <Eigen/Core>

#include "arfm_vo/geometry/stereo_camera.h"
#include "arfm_vo/pose/point_observation.h"

namespace arfm_vo {

/// Nearer than this before the camera plane, m, a point counts as behind the camera.
constexpr double kMinDepth = 1e-3;

/// Observed minus projected (u_left, v, u_right), px; 0 for a right pixel that is not there. The
/// point must lie before the camera.
inline Eigen::Vector3d ReprojectionError(const StereoCamera& camera,
                                         const PointObservation& observation,
                                         const Eigen::Vector3d& x_in_camera) {
  Eigen::Vector3d error = observation.pixels - camera.ProjectStereo(x_in_camera);
  if (!observation.has_right) error.z() = 0;
  return error;
}

/// Derivative of StereoCamera::ProjectStereo by the point, [3 x 3].
inline Eigen::Matrix3d ProjectionJacobian(const StereoCamera& camera,
                                          const Eigen::Vector3d& x_in_camera) {
  const double inverse_z = 1 / x_in_camera.z();
  const double fx_z = camera.fx * inverse_z, fy_z = camera.fy * inverse_z;
  Eigen::Matrix3d jacobian;
  jacobian << fx_z, 0, -fx_z * x_in_camera.x() * inverse_z,  //
      0, fy_z, -fy_z * x_in_camera.y() * inverse_z,          //
      fx_z, 0, -fx_z * (x_in_camera.x() - camera.baseline_m) * inverse_z;
  return jacobian;
}

}  // namespace arfm_vo
