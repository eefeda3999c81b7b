#pragma once

#include <vector>

#include "arfm_vo/driving/route.h"

namespace arfm_vo {

/// The shortest way over driven ground from where the rover stands to where `driven` begins, to be
/// taken there with the heading that the rover had: back along the path, from one branch to another
/// where they meet, smoothed by 0.1 m (Douglas and Peucker 1973). Throws std::invalid_argument
/// where the path is empty, has a gap on the way, or the rover stands beside it.
Route FindWayHome(const std::vector<RoverPose>& driven, const RoverPose& rover);

}  // namespace arfm_vo
