#pragma once

#include <opencv2/core.hpp>

namespace arfm_vo {

/// Normal noise on the grey values of `image` (CV_8U), as pixels of a camera have it.
inline void AddNoise(cv::Mat& image, double sigma_grey_levels, cv::RNG& random) {
  cv::Mat noise(image.size(), CV_16S);
  random.fill(noise, cv::RNG::NORMAL, 0, sigma_grey_levels);
  cv::add(image, noise, image, cv::noArray(), CV_8U);
}

}  // namespace arfm_vo
