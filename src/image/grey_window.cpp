#include "arfm_vo/image/grey_window.h"

#include <opencv2/core.hpp>

namespace arfm_vo {

cv::Mat GreyWindow::Apply(const cv::Mat& deep) {
  double brightest = 0;
  cv::minMaxLoc(deep, nullptr, &brightest);
  while (brightest >= 1 << bits_) bits_ += 2;  // 16 bits hold all
  cv::Mat grey;
  deep.convertTo(grey, CV_8U, 1.0 / (1 << (bits_ - 8)));
  return grey;
}

}  // namespace arfm_vo
