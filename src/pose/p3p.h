#pragma once

#include <Eigen/Core>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// The camera poses (camera_from_world) in which three rays see three points, four at most (Persson
/// and Nordberg, Lambda Twist, ECCV 2018): the distances of the points from the camera lie where
/// two cones meet, and one of the cones' pencil falls apart into two planes.
///   x_in_world  [3 x 3] m, a point a column
///   rays        [2 x 3] normalised image coordinates ((u - cx) / fx, (v - cy) / fy)
/// None where the points lie on a line.
std::vector<Rigid3> SolveP3p(const Eigen::Matrix3d& x_in_world,
                             const Eigen::Matrix<double, 2, 3>& rays);

}  // namespace arfm_vo
