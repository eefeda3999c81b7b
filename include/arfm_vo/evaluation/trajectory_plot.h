#pragma once

#include <string>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// Draws the estimate and, where `truth` is not empty, the truth (world_from_camera of the same
/// frames) from above, and the error of the position over the distance driven, as a PNG file, by
/// gnuplot. Both are laid on each other at their first pose. Throws std::runtime_error saying why
/// where there is no picture.
void PlotTrajectory(const std::vector<Rigid3>& estimate, const std::vector<Rigid3>& truth,
                    const std::string& png_path);

}  // namespace arfm_vo
