#pragma once

#include <string>
#include <vector>

#include "arfm_vo/geometry/stereo_camera.h"

namespace arfm_vo {

/// Camera `left` (0: grey, 2: colour) and the next of a KITTI calibration file: projection matrices
/// such as `P0:` and `P1:` (odometry) or `P_rect_00:` and `P_rect_01:` (raw data), 12 numbers each.
/// The frame is that of the left of the two. Throws std::invalid_argument naming file and key where
/// one is missing or stands twice, is not 12 finite numbers, where the two are not a rectified
/// pair, or the baseline is not in (0, 10) m. `width` and `height` are those given.
StereoCamera ReadKittiCalibration(const std::string& path, int left, int width, int height);

/// The stamps of a times.txt (seconds, one a line) or of a timestamps.txt of the raw data (lines as
/// 2011-09-26 13:02:25.964389445; made relative to the first). Throws std::invalid_argument naming
/// file and line where one cannot be read, is not finite or not later than the one before.
std::vector<double> ReadKittiTimes(const std::string& path);

}  // namespace arfm_vo
