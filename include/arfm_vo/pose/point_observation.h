#pragma once

#include <Eigen/Core>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

namespace arfm_vo {

/// A known point in space and where the stereo camera sees it now: one 2D-3D correspondence.
struct PointObservation {
  Eigen::Vector3d x_in_world;  ///< m
  /// m^2; symmetric and positive semi-definite; zero = the point is exact.
  Eigen::Matrix3d x_covariance = Eigen::Matrix3d::Zero();
  Eigen::Vector3d pixels;  ///< (u_left, v, u_right), px; u_right is not read unless has_right
  bool has_right = true;
  double sigma_px = 1;    ///< standard deviation of each of `pixels`; positive
  double reach_px = 40;   ///< it was looked for so far around where it was expected; positive
  double votes = 1;       ///< for a pose that it agrees with, against others; not negative
  bool is_proven = true;  ///< agreed with earlier poses

  /// Number of coordinates seen: 3, or 2 where the right image does not see the point.
  int NumCoordinates() const { return has_right ? 3 : 2; }
  bool IsValid() const {
    return x_in_world.allFinite() && x_covariance.allFinite() && pixels.head<2>().allFinite() &&
           (!has_right || std::isfinite(pixels.z())) && std::isfinite(sigma_px) && sigma_px > 0;
  }
};

/// Throws std::invalid_argument naming the first observation that is not valid.
inline void RequireValid(const std::vector<PointObservation>& observations) {
  for (size_t i = 0; i < observations.size(); ++i) {
    if (observations[i].IsValid()) continue;
    throw std::invalid_argument("point observation " + std::to_string(i) +
                                ": not finite, or sigma_px not positive");
  }
}

}  // namespace arfm_vo
