#pragma once

#include <Eigen/Core>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// What is left of the right camera's rotation after rectification: x_in_right =
/// Exp(rotation) * (x_in_left - (baseline, 0, 0)). About x it moves the right image's rows, about
/// y its columns (and so all disparities), about z it turns the picture.
struct StereoCorrection {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();  ///< rad
};

/// x_in_right of a point in the left camera frame.
inline Eigen::Vector3d RightFromLeft(const StereoCamera& camera, const StereoCorrection& correction,
                                     const Eigen::Vector3d& x_in_left) {
  return ExpSO3(correction.rotation) *
         Eigen::Vector3d(x_in_left - Eigen::Vector3d(camera.baseline_m, 0, 0));
}

/// (u_left, v_left, u_right, v_right) of a point in the left camera frame, which must lie before
/// both cameras.
inline Eigen::Vector4d ProjectStereo4(const StereoCamera& camera,
                                      const StereoCorrection& correction,
                                      const Eigen::Vector3d& x_in_left) {
  Eigen::Vector4d pixels;
  pixels << camera.Project(x_in_left), camera.Project(RightFromLeft(camera, correction, x_in_left));
  return pixels;
}

/// Where the nominal right camera (`rotation` zero) would have seen what the real one sees at
/// (u_right, v_right). Exact for every depth: a rotation moves rays, not their origin.
inline Eigen::Vector2d NominalRightPixel(const StereoCamera& camera,
                                         const StereoCorrection& correction,
                                         const Eigen::Vector2d& right_pixel) {
  const Eigen::Vector3d ray((right_pixel.x() - camera.cx) / camera.fx,
                            (right_pixel.y() - camera.cy) / camera.fy, 1);
  return camera.Project(ExpSO3(-correction.rotation) * ray);
}

}  // namespace arfm_vo
