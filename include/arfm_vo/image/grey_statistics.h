#pragma once

#include <opencv2/core/mat.hpp>

namespace arfm_vo {

/// Brightness and contrast of an image.
struct GreyStatistics {
  double mean = 0;      ///< grey levels, eq 4
  double variance = 0;  ///< grey levels squared, over M x N (not M x N - 1), eq 5
};

/// Mean grey level (eq 4) and mean squared deviation from it (eq 5), exact but for the last
/// division. Throws std::invalid_argument unless `grey` is CV_8UC1 and not empty.
GreyStatistics ComputeGreyStatistics(const cv::Mat& grey);

}  // namespace arfm_vo
