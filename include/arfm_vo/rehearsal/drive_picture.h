#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "arfm_vo/rehearsal/rehearsal.h"

namespace arfm_vo {

/// The drive seen from above (CV_8UC3): shaded ground with contours every 0.25 m, the true way, the
/// way by sight, start, goal, a scale of 1 m, and the figures in words. `start` is where the map's
/// origin lies in the world, whose y axis points up in the picture.
cv::Mat DrawDrive(const Terrain& terrain, const RoverPose& start, const Drive& drive);

/// Writes that picture as PNG, whole or not at all. Throws std::runtime_error naming the file.
void SaveDrive(const std::string& path, const Terrain& terrain, const RoverPose& start,
               const Drive& drive);

}  // namespace arfm_vo
