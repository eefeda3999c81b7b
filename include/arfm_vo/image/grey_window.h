#pragma once

#include <opencv2/core/mat.hpp>

namespace arfm_vo {

/// Makes 8 bit grey of the 16 bit images of one camera: of 8, 10, 12, 14 or 16 bits the fewest that
/// hold all values so far are shown, from 0 to the largest value of so many bits. The window is
/// that of the first image, and is widened where a later one is brighter; it never narrows.
class GreyWindow {
 public:
  /// `deep` is CV_16UC1; returns CV_8UC1.
  cv::Mat Apply(const cv::Mat& deep);
  int bits() const { return bits_; }

 private:
  int bits_ = 8;
};

}  // namespace arfm_vo
