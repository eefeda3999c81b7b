#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace arfm_vo {

/// A rectified stereo pair of pinhole cameras (eq 1) with the same intrinsics; the right camera
/// sits `baseline_m` along +x of the left one. Camera frame: x right, y down, z forward; pixel (0,
/// 0) is the centre of the top left pixel.
struct StereoCamera {
  double fx = 0, fy = 0, cx = 0, cy = 0;  ///< px
  double baseline_m = 0;
  int width = 0, height = 0;  ///< px

  /// Throws std::invalid_argument naming the value unless focal lengths and size are positive, all
  /// values are finite and 0 < baseline_m < 10.
  void Check() const;
  bool operator==(const StereoCamera& other) const;

  /// The left pixel (u, v) of a point in the left camera frame; z must be positive.
  Eigen::Vector2d Project(const Eigen::Vector3d& x_in_camera) const {
    return {fx * x_in_camera.x() / x_in_camera.z() + cx,
            fy * x_in_camera.y() / x_in_camera.z() + cy};
  }
  /// (u_left, v, u_right) of a point in the left camera frame; z must be positive.
  Eigen::Vector3d ProjectStereo(const Eigen::Vector3d& x_in_camera) const {
    const Eigen::Vector2d uv = Project(x_in_camera);
    return {uv.x(), uv.y(), uv.x() - Disparity(x_in_camera.z())};
  }
  /// disp = T f / Z (eq 6), px.
  double Disparity(double depth_m) const { return baseline_m * fx / depth_m; }
  /// Z = T f / disp (eq 6), m; `disparity_px` must be positive.
  double Depth(double disparity_px) const { return baseline_m * fx / disparity_px; }
  /// The point of a left pixel with disparity (eqs 1, 6), in the left camera frame; `disparity_px`
  /// must be positive.
  Eigen::Vector3d Triangulate(double u, double v, double disparity_px) const {
    const double z = Depth(disparity_px);
    return {(u - cx) * z / fx, (v - cy) * z / fy, z};
  }
  /// The same of a disparity as measured, which noise and calibration may make negative where the
  /// point is far: it then stands where its disparity is kFarthestDisparityPx.
  Eigen::Vector3d TriangulateMeasured(double u, double v, double disparity_px) const {
    return Triangulate(u, v, std::max(disparity_px, kFarthestDisparityPx));
  }
  static constexpr double kFarthestDisparityPx = 0.1;
  bool Contains(const Eigen::Vector2d& uv, double border_px = 0) const {
    return uv.x() >= border_px && uv.y() >= border_px && uv.x() <= width - 1 - border_px &&
           uv.y() <= height - 1 - border_px;
  }
};

}  // namespace arfm_vo
