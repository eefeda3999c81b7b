#pragma once

#include <Eigen/Core>
#include <optional>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// The camera pose (camera_from_world) from n >= 4 points and the rays that see them: EPnP
/// (Lepetit, Moreno-Noguer and Fua, IJCV 2009; eqs 7, 8 of the paper). The points are weighted
/// sums of four control points (three where they lie in a plane), whose camera coordinates are
/// found in the null space of a 2n x 12 system; absolute orientation then gives the motion. Linear
/// in n, no heap.
///   x_in_world  [3 x n] m
///   rays        [2 x n] normalised image coordinates ((u - cx) / fx, (v - cy) / fy)
/// Nothing is returned for n < 4, sizes that differ, values that are not finite, points on a line
/// or in one place, or where the solution leaves a point behind the camera.
std::optional<Rigid3> SolveEpnp(const Eigen::Ref<const Eigen::Matrix3Xd>& x_in_world,
                                const Eigen::Ref<const Eigen::Matrix2Xd>& rays);

}  // namespace arfm_vo
