#pragma once

#include <Eigen/Core>

namespace arfm_vo {

/// Where both images show one point, as measured: before any correction. There are many: 24 bytes,
/// and whose observation it is in 8 more.
struct StereoObservation {
  Eigen::Vector4f pixels;  ///< (u_left, v_left, u_right, v_right), px
  bool has_right = true;   ///< false: u_right, v_right hold nothing and are not read
  float sigma_px = 1;      ///< standard deviation of each coordinate; positive

  Eigen::Vector4d Pixels() const { return pixels.cast<double>(); }
  int NumCoordinates() const { return has_right ? 4 : 2; }
};

}  // namespace arfm_vo
