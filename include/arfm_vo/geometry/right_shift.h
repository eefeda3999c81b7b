#pragma once

#include <Eigen/Core>

#include "arfm_vo/geometry/rigid3.h"
#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// By how much a right picture taken when the camera has moved by `later_from_now` shows a point of
/// the left camera frame elsewhere: (du, dv), px. The point must lie before the camera both times.
inline Eigen::Vector2d ShiftOfRight(const StereoCamera& camera, const Rigid3& later_from_now,
                                    const Eigen::Vector3d& x_in_left) {
  if (later_from_now.IsIdentity()) return {0, 0};
  const Eigen::Vector3d now = camera.ProjectStereo(x_in_left);
  const Eigen::Vector3d later = camera.ProjectStereo(later_from_now * x_in_left);
  return {later.z() - now.z(), later.y() - now.y()};
}

}  // namespace arfm_vo
