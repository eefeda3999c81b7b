#include "arfm_vo/reconstruction/stereo_point.h"

namespace arfm_vo {

Eigen::Matrix3d PointCovariance(const StereoCamera& camera, const StereoPoint& point) {
  // d(x, y, z) / d(u, v, disparity) of eq 6; left and right columns err independently.
  const Eigen::Vector3d& x = point.x_in_camera;
  const double dz = -x.z() * x.z() / (camera.fx * camera.baseline_m);
  Eigen::Matrix3d jacobian;
  jacobian << x.z() / camera.fx, 0, x.x() / x.z() * dz,  //
      0, x.z() / camera.fy, x.y() / x.z() * dz,          //
      0, 0, dz;
  Eigen::Matrix3d pixels;
  pixels << 1, 0, 1, 0, 1, 0, 1, 0, 2;
  return point.sigma_px * point.sigma_px * jacobian * pixels * jacobian.transpose();
}

Eigen::Vector3d SurfaceNormal(const StereoCamera& camera, const StereoPoint& point) {
  // The plane m X = 1 has the disparity f b m r along the ray r = X / z.
  const Eigen::Vector3d& x = point.x_in_camera;
  Eigen::Vector3d m;
  m.head<2>() = point.disparity_gradient / camera.baseline_m;
  m.y() *= camera.fy / camera.fx;
  m.z() = (1 - m.head<2>().dot(x.head<2>())) / x.z();
  return m.normalized();
}

}  // namespace arfm_vo
