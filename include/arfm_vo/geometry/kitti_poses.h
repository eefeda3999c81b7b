#pragma once

#include <string>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// world_from_camera of each frame from a KITTI pose file: 12 numbers a line, the rows of [R | t].
/// Throws std::invalid_argument naming file and line where a line is not that: not 12 finite
/// numbers, or R further than 1e-3 from a rotation (it is made one exactly).
std::vector<Rigid3> ReadKittiPoses(const std::string& path);

}  // namespace arfm_vo
