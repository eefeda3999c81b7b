#pragma once

#include <Eigen/Core>

namespace arfm_vo {

/// Where both images show one point, as measured: before any correction.
struct StereoObservation {
  Eigen::Vector4d pixels;  ///< (u_left, v_left, u_right, v_right), px
  bool has_right = true;   ///< false: u_right, v_right hold nothing and are not read
  double sigma_px = 1;     ///< standard deviation of each coordinate; positive

  int NumCoordinates() const { return has_right ? 4 : 2; }
};

}  // namespace arfm_vo
