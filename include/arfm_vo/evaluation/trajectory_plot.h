#pragma once

#include <string>
#include <vector>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// world_from_camera, and what is drawn beside it.
struct PlottedPath {
  std::vector<Rigid3> estimate;
  std::vector<bool> is_tracked;  ///< [estimate]; empty: all. To and from the others it is dashed
  std::vector<Rigid3> truth;     ///< [estimate], or empty where it is not known
};

/// What gnuplot is told: the estimate and the truth from above, and the error of the position over
/// the distance driven. Both are laid on each other at their first pose.
std::string WritePlotScript(const PlottedPath& path, const std::string& png_path);

/// Draws that as a PNG file. Throws std::runtime_error saying why where there is no picture.
void PlotTrajectory(const PlottedPath& path, const std::string& png_path);

}  // namespace arfm_vo
