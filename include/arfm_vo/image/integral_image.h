#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace arfm_vo {

/// Integral image (eq 2): `row(y)[x]` is the sum of the grey levels in the rectangle from the
/// origin to (x, y), the column x and the row y themselves left out, so that the first row and
/// column are 0 and a box with half-open bounds needs no special case. Sums wrap around in 32 bits;
/// sums over boxes of less than 8 million pixels are exact nevertheless.
class IntegralImage {
 public:
  IntegralImage() = default;
  /// Throws std::invalid_argument unless `grey` is CV_8UC1 and not empty.
  explicit IntegralImage(const cv::Mat& grey) { Compute(grey); }

  /// As the constructor, but reuses the memory.
  void Compute(const cv::Mat& grey);

  int rows() const { return rows_; }  ///< of the image
  int cols() const { return cols_; }  ///< of the image

  /// y in 0..rows(). Valid for x in 0..cols(); up to 16 further values may be read (not used).
  const uint32_t* row(int y) const { return sums_.data() + static_cast<size_t>(y) * stride_; }
  /// Distance of two rows, in values.
  int stride() const { return stride_; }

  /// Sum over the pixels left <= x < right, top <= y < bottom, all within the image.
  int32_t BoxSum(int left, int top, int right, int bottom) const {
    const uint32_t* above = row(top);
    const uint32_t* below = row(bottom);
    return static_cast<int32_t>(below[right] - below[left] - above[right] + above[left]);
  }

 private:
  int rows_ = 0, cols_ = 0, stride_ = 0;
  std::vector<uint32_t> sums_;  ///< [(rows + 1) x stride]
};

}  // namespace arfm_vo
