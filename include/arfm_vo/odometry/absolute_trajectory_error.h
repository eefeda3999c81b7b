#pragma once

#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// The motion that brings `points` onto `targets` with the least sum of squares (FindRotation).
/// Throws std::invalid_argument where their numbers differ or are 0.
Rigid3 AlignPoints(const std::vector<Eigen::Vector3d>& points,
                   const std::vector<Eigen::Vector3d>& targets);

/// ATE: root mean square distance, m, between true and estimated positions after AlignPoints. Both
/// hold world_from_camera of the same frames. Throws as AlignPoints does.
double ComputeAbsoluteTrajectoryError(const std::vector<Rigid3>& truth,
                                      const std::vector<Rigid3>& estimate);

}  // namespace arfm_vo
