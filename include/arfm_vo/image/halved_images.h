#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

namespace arfm_vo {

/// An image at 1/2, 1/4 .. 1/2^kMostHalved of its size.
using HalvedImages = std::vector<cv::Mat>;
constexpr int kMostHalved = 3;

/// Nothing of an empty image.
HalvedImages Halve(const cv::Mat& grey);

}  // namespace arfm_vo
