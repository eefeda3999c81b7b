#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "arfm_vo/image/grey_window.h"

namespace arfm_vo {

/// A PNG file as CV_8UC1; colours are turned to grey, 16 bits a sample by `window`. Throws
/// std::invalid_argument naming the file where it cannot be read, is no PNG, is truncated (also
/// where only its end is missing), or is corrupted.
cv::Mat ReadGreyPng(const std::string& path, GreyWindow& window);

}  // namespace arfm_vo
