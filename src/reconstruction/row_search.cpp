#include "arfm_vo/reconstruction/row_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace arfm_vo {
namespace {

constexpr int kSize = 12;    ///< samples a side, at half size
constexpr int kStride = 16;  ///< of a row of the template, zero from kSize on
constexpr int kNumSamples = kSize * kSize;
/// Least correlation of the best place.
constexpr double kMinZncc = 0.8;
/// Most of (1 - best) / (1 - second-best correlation).
constexpr double kMaxAmbiguity = 0.7;

/// Grey values less their mean, as 16 bit integers: at most 255 * 12 * 12 * 128 in a sum.
struct Template {
  alignas(16) std::array<int16_t, kSize * kStride> values{};
  float norm = 0;

  Template(const cv::Mat& grey, int left, int top) {
    int sum = 0;
    for (int r = 0; r < kSize; ++r) {
      for (int c = 0; c < kSize; ++c) sum += grey.at<uint8_t>(top + r, left + c);
    }
    const int mean = (sum + kNumSamples / 2) / kNumSamples;
    int remainder = 0, squares = 0;
    for (int r = 0; r < kSize; ++r) {
      for (int c = 0; c < kSize; ++c) {
        const int value = grey.at<uint8_t>(top + r, left + c) - mean;
        values[r * kStride + c] = static_cast<int16_t>(value);
        remainder += value;
        squares += value * value;
      }
    }
    sum_ = remainder;
    norm = std::sqrt(static_cast<float>(squares) -
                     static_cast<float>(remainder) * static_cast<float>(remainder) / kNumSamples);
  }
  /// Sum of products with the samples at `from`; 16 bytes a row are read.
  int Correlate(const uint8_t* from, size_t step) const {
    cv::v_int32x4 sum = cv::v_setzero_s32();
    for (int r = 0; r < kSize; ++r, from += step) {
      cv::v_uint16x8 low, high;
      cv::v_expand(cv::v_load(from), low, high);
      sum = cv::v_dotprod(cv::v_reinterpret_as_s16(low), cv::v_load_aligned(&values[r * kStride]),
                          sum);
      sum = cv::v_dotprod(cv::v_reinterpret_as_s16(high),
                          cv::v_load_aligned(&values[r * kStride + 8]), sum);
    }
    return cv::v_reduce_sum(sum);
  }
  /// Sum of the values: not quite 0 for the rounding of the mean.
  int sum() const { return sum_; }

 private:
  int sum_ = 0;
};

/// Sums and sums of squares of the columns of a strip of kSize rows.
struct ColumnSums {
  std::vector<int> sums, squares;

  ColumnSums(const cv::Mat& grey, int left, int top, int columns)
      : sums(columns), squares(columns) {
    for (int r = 0; r < kSize; ++r) {
      const uint8_t* row = grey.ptr(top + r) + left;
      for (int c = 0; c < columns; ++c) {
        sums[c] += row[c];
        squares[c] += row[c] * row[c];
      }
    }
  }
};

/// Correlation coefficients of the template with every window of a strip.
std::vector<float> CorrelateStrip(const Template& patch, const cv::Mat& grey, int left, int top,
                                  int count) {
  const ColumnSums columns(grey, left, top, count + kSize - 1);
  std::vector<float> scores(count);
  int sum = 0, squares = 0;
  for (int c = 0; c < kSize - 1; ++c) {
    sum += columns.sums[c];
    squares += columns.squares[c];
  }
  for (int i = 0; i < count; ++i) {
    sum += columns.sums[i + kSize - 1];
    squares += columns.squares[i + kSize - 1];
    const float grey_sum = static_cast<float>(sum), mean = grey_sum / kNumSamples;
    const float variance = static_cast<float>(squares) - mean * grey_sum;
    const int products = patch.Correlate(grey.ptr(top) + left + i, grey.step);
    const float product = static_cast<float>(products) - mean * static_cast<float>(patch.sum());
    scores[i] = variance > 0 ? product / (patch.norm * std::sqrt(variance)) : -1;
    sum -= columns.sums[i];
    squares -= columns.squares[i];
  }
  return scores;
}

/// Where the parabola through three values at -1, 0, 1 is highest, within +-0.5.
float ParabolaPeak(float before, float at, float after) {
  const float curvature = before - 2 * at + after;
  return curvature < 0 ? std::clamp(0.5f * (before - after) / curvature, -0.5f, 0.5f) : 0;
}

}  // namespace

void RowSearch::SetImages(const cv::Mat& left, const cv::Mat& right) {
  cv::pyrDown(left, left_);
  cv::pyrDown(right, right_);
}

std::optional<cv::Point2f> RowSearch::Find(const cv::Point2f& left_pixel, double row_offset_px,
                                           double min_disparity_px, double max_disparity_px) const {
  const int x = cvRound(0.5 * left_pixel.x) - kSize / 2;
  const int y = cvRound(0.5 * left_pixel.y) - kSize / 2;
  const int right_y = y + cvRound(0.5 * row_offset_px);
  const int first = std::max(0, x - static_cast<int>(std::ceil(0.5 * max_disparity_px)));
  const int last =
      std::min(right_.cols - kStride, x - static_cast<int>(std::floor(0.5 * min_disparity_px)));
  if (x < 0 || x + kSize > left_.cols || std::min(y, right_y) < 0 ||
      std::max(y, right_y) + kSize > left_.rows || last - first < 2) {
    return std::nullopt;
  }
  const Template patch(left_, x, y);
  if (!(patch.norm > 0)) return std::nullopt;
  const std::vector<float> scores = CorrelateStrip(patch, right_, first, right_y, last - first + 1);
  const int best =
      static_cast<int>(std::max_element(scores.begin() + 1, scores.end() - 1) - scores.begin());
  if (scores[best] < kMinZncc) return std::nullopt;
  constexpr int kPeakWidth = 2;
  float second = -1;
  for (int i = 0; i < static_cast<int>(scores.size()); ++i) {
    if (std::abs(i - best) > kPeakWidth) second = std::max(second, scores[i]);
  }
  constexpr float kRounding = 1e-3f;  // two perfect places can't be told apart
  if (1 - scores[best] + kRounding > kMaxAmbiguity * (1 - second + kRounding)) {
    return std::nullopt;
  }
  const float peak = ParabolaPeak(scores[best - 1], scores[best], scores[best + 1]);
  return cv::Point2f(
      left_pixel.x + 2 * (static_cast<float>(first + best) + peak - static_cast<float>(x)),
      left_pixel.y + static_cast<float>(row_offset_px));
}

}  // namespace arfm_vo
