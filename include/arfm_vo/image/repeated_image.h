#pragma once

#include <algorithm>
#include <opencv2/core/mat.hpp>

namespace arfm_vo {

/// Tells pictures that are bit by bit the one before. No camera that works gives them, even at
/// rest: its pixels are noisy.
class RepeatedImage {
 public:
  /// `image`: CV_8U; may be changed by its owner afterwards.
  bool Look(const cv::Mat& image) {
    const bool is_repeated = IsLast(image);
    if (!is_repeated) image.copyTo(last_);
    return is_repeated;
  }

 private:
  bool IsLast(const cv::Mat& image) const {
    if (image.size() != last_.size() || image.empty()) return false;
    for (int y = 0; y < image.rows; ++y) {
      if (!std::equal(image.ptr(y), image.ptr(y) + image.cols, last_.ptr(y))) return false;
    }
    return true;
  }

  cv::Mat last_;
};

}  // namespace arfm_vo
