#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "arfm_vo/calibration/corner_detection.h"

namespace arfm_vo {

/// Where in an eye's image the board was seen: distortion is known only there.
struct Coverage {
  cv::Mat counts;    ///< [8 x 10] CV_32S, corners in each cell of the image
  double share = 0;  ///< of the cells that hold at least one corner

  explicit Coverage(const std::vector<BoardCorners>& views, cv::Size image_size);
};

}  // namespace arfm_vo
