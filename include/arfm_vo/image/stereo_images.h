#pragma once

#include <opencv2/core/mat.hpp>

namespace arfm_vo {

/// A rectified stereo pair taken at one time. Both images are grey, 8 bit (CV_8UC1) and of the same
/// size.
struct StereoImages {
  double stamp_s = 0;
  cv::Mat left, right;

  /// Throws std::invalid_argument unless both images are CV_8UC1, not empty and of the same size.
  void Check() const;
};

}  // namespace arfm_vo
