#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// A left keypoint that was found in the right image, and its point in space (eq 6).
struct StereoPoint {
  int keypoint = 0;  ///< index into the left image's Features
  /// (u_left, v, u_right), px; v is measured in the left image
  Eigen::Vector3d observation = Eigen::Vector3d::Zero();
  double row_residual_px = 0;  ///< v_right - v_left
  double sigma_px = 1;         ///< standard deviation of each coordinate of `observation`
  Eigen::Vector3d x_in_camera = Eigen::Vector3d::Zero();  ///< m, left camera frame
  /// d disparity / d(u_left, v): how the surface slants; zero where it faces the camera.
  Eigen::Vector2d disparity_gradient = Eigen::Vector2d::Zero();
  /// False: placed by motion, from the left camera alone; u_right is where the right one would see
  /// it.
  bool has_right = true;
};
using StereoPoints = std::vector<StereoPoint>;

/// Covariance of a point's place (eq 6), m^2, camera frame.
Eigen::Matrix3d PointCovariance(const StereoCamera& camera, const StereoPoint& point);

/// The unit normal of the surface around a point, camera frame, away from the camera, from its
/// disparity gradient.
Eigen::Vector3d SurfaceNormal(const StereoCamera& camera, const StereoPoint& point);

}  // namespace arfm_vo
