#include "arfm_vo/image/integral_image.h"

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
  }  // else the first row, the first column and what lies beyond the last are 0 already
  for (int y = 0; y < rows_; ++y) {
    const uint8_t* pixels = grey.ptr(y);
    const uint32_t* above = row(y);
    uint32_t* sums = sums_.data() + static_cast<size_t>(y + 1) * stride_;
    uint32_t row_sum = 0;
    for (int x = 0; x < cols_; ++x) {
      row_sum += pixels[x];
      sums[x + 1] = above[x + 1] + row_sum;
    }
  }
}

}  // namespace arfm_vo
