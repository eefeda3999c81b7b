#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

namespace arfm_vo {

/// Width and height of a PNG file from its header. Throws std::invalid_argument naming the file.
cv::Size ReadPngSize(const std::string& path);

/// A PNG file as CV_8UC1; colours are turned to grey. Throws std::invalid_argument naming the file
/// where it cannot be read, is no PNG, is truncated (also where only its end is missing, which
/// libpng forgives), is corrupted, or has 16 bits a sample.
cv::Mat ReadGreyPng(const std::string& path);

}  // namespace arfm_vo
