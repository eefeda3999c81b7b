#pragma once

#include <opencv2/core/mat.hpp>

#include "arfm_vo/rehearsal/rehearsal.h"

namespace arfm_vo {

/// The drive seen from above (CV_8UC3): shaded ground with contours every 0.25 m, the true way, the
/// way by sight, start, goal, a scale of 1 m, and the figures in words. North is up.
cv::Mat DrawDrive(const GoalScene& scene, const Drive& drive);

}  // namespace arfm_vo
