#include "arfm_vo/image/integral_image.h"

#include <opencv2/imgproc.hpp>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {
constexpr int kReadAhead = 16;  ///< values that a vector load may touch beyond the last column
}  // namespace

void IntegralImage::Compute(const cv::Mat& grey) {
  Require(!grey.empty(), "integral image: the image is empty");
  Require(grey.type() == CV_8UC1, "integral image: the image must be 8 bit grey");
  if (grey.rows != rows_ || grey.cols != cols_) {
    rows_ = grey.rows;
    cols_ = grey.cols;
    stride_ = cols_ + 1 + kReadAhead;
    sums_.assign(static_cast<size_t>(rows_ + 1) * stride_ + kReadAhead, 0);
  }  // else what lies beyond the last column is 0 already
  cv::Mat sums(rows_ + 1, cols_ + 1, CV_32SC1, sums_.data(), stride_ * sizeof(uint32_t));
  cv::integral(grey, sums, CV_32S);
}

}  // namespace arfm_vo
