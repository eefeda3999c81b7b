#pragma once

#include <array>
#include <cmath>
#include <opencv2/core/hal/intrin.hpp>
#include <opencv2/core/mat.hpp>

namespace arfm_vo {

/// Weights of four neighbouring pixels for a place `t` in [0, 1) past the second: the cubic through
/// the four (Lagrange). Its phase error, which is what shifts an alignment, is a third to a fifth
/// of that of cubic convolution (Keys 1981), and that one's is no better than linear
/// interpolation's.
inline std::array<float, 4> CubicWeights(float t) {
  const float a = t + 1, b = t - 1, c = t - 2;
  return {-t * b * c / 6, a * b * c / 2, -a * t * c / 2, a * t * b / 6};
}

/// Rows of samples are padded to whole vectors of 4.
constexpr int PaddedToVectors(int columns) { return (columns + 3) / 4 * 4; }

/// Interpolates kRows x kColumns samples 1 px apart, the first at `corner`, into rows of
/// PaddedToVectors(kColumns). False where they or the pixels around them lie outside `grey`.
template <int kRows, int kColumns>
bool Interpolate(const cv::Mat& grey, const cv::Point2f& corner, float* samples) {
  using cv::v_float32x4;
  constexpr int kOutput = PaddedToVectors(kColumns);
  constexpr int kInput = kOutput + 4;
  const float floor_x = std::floor(corner.x), floor_y = std::floor(corner.y);
  if (!(floor_x >= 1 && floor_y >= 1 && floor_x - 1 + kInput <= grey.cols &&
        floor_y + kRows + 2 <= grey.rows)) {
    return false;
  }
  const int x = static_cast<int>(floor_x) - 1, y = static_cast<int>(floor_y) - 1;
  const auto weights_x = CubicWeights(corner.x - floor_x);
  const auto weights_y = CubicWeights(corner.y - floor_y);
  v_float32x4 wx[4], wy[4];
  for (int k = 0; k < 4; ++k) {
    wx[k] = cv::v_setall_f32(weights_x[k]);
    wy[k] = cv::v_setall_f32(weights_y[k]);
  }
  alignas(16) float column_sums[kRows][kInput];
  for (int c = 0; c < kInput; c += 4) {
    v_float32x4 pixels[4];
    const auto read = [&](int r) {
      return cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_load_expand_q(grey.ptr(y + r) + x + c)));
    };
    for (int k = 1; k < 4; ++k) pixels[k] = read(k - 1);
    for (int r = 0; r < kRows; ++r) {
      for (int k = 0; k < 3; ++k) pixels[k] = pixels[k + 1];
      pixels[3] = read(r + 3);
      cv::v_store_aligned(column_sums[r] + c, cv::v_fma(wy[3], pixels[3], wy[2] * pixels[2]) +
                                                  cv::v_fma(wy[1], pixels[1], wy[0] * pixels[0]));
    }
  }
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kOutput; c += 4) {
      const float* from = column_sums[r] + c;
      const v_float32x4 sum =
          cv::v_fma(wx[3], cv::v_load(from + 3), wx[2] * cv::v_load(from + 2)) +
          cv::v_fma(wx[1], cv::v_load(from + 1), wx[0] * cv::v_load_aligned(from));
      cv::v_store(samples + r * kOutput + c, sum);
    }
  }
  return true;
}

/// One sample. False where it or the pixels around it lie outside `grey`.
inline bool InterpolateOne(const cv::Mat& grey, const cv::Point2f& at, float& sample) {
  const float floor_x = std::floor(at.x), floor_y = std::floor(at.y);
  if (!(floor_x >= 1 && floor_y >= 1 && floor_x + 3 <= grey.cols && floor_y + 3 <= grey.rows)) {
    return false;
  }
  const auto weights_x = CubicWeights(at.x - floor_x);
  const auto weights_y = CubicWeights(at.y - floor_y);
  const uint8_t* row = grey.ptr(static_cast<int>(floor_y) - 1) + static_cast<int>(floor_x) - 1;
  cv::v_float32x4 sum = cv::v_setzero_f32();
  for (int r = 0; r < 4; ++r, row += grey.step) {
    const auto pixels = cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_load_expand_q(row)));
    sum = cv::v_fma(cv::v_setall_f32(weights_y[r]), pixels, sum);
  }
  sample = cv::v_reduce_sum(sum * cv::v_load(weights_x.data()));
  return true;
}

}  // namespace arfm_vo
