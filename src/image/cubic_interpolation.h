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

/// Interpolates kRows x kColumns samples at centre + source_from_patch * (c - (kColumns - 1) / 2,
/// r - (kRows - 1) / 2) into rows of PaddedToVectors(kColumns). False where they, the padding or
/// the pixels around them lie outside `grey`.
template <int kRows, int kColumns>
bool InterpolateWarped(const cv::Mat& grey, const cv::Point2f& centre,
                       const cv::Matx22f& source_from_patch, float* samples) {
  using cv::v_float32x4;
  constexpr int kOutput = PaddedToVectors(kColumns);
  constexpr float kLeft = -0.5f * (kColumns - 1), kTop = -0.5f * (kRows - 1);
  const auto place = [&](float column, float row) {
    const cv::Vec2f offset = source_from_patch * cv::Vec2f(kLeft + column, kTop + row);
    return centre + cv::Point2f(offset[0], offset[1]);
  };
  constexpr float kRounding = 1e-3f;  // the samples' places are summed up in another order
  for (const int column : {0, kOutput - 1}) {
    for (const int row : {0, kRows - 1}) {
      const cv::Point2f at = place(column, row);
      if (!(at.x >= 1 + kRounding && at.y >= 1 + kRounding && at.x < grey.cols - 2 - kRounding &&
            at.y < grey.rows - 2 - kRounding)) {
        return false;
      }
    }
  }
  const auto weigh = [](const v_float32x4& t, v_float32x4 weights[4]) {
    const v_float32x4 one = cv::v_setall_f32(1), sixth = cv::v_setall_f32(1.0f / 6),
                      half = cv::v_setall_f32(0.5f);
    const v_float32x4 a = t + one, b = t - one, c = b - one;
    const v_float32x4 bc = b * c, at = a * t;
    weights[0] = cv::v_setzero_f32() - t * bc * sixth;
    weights[1] = a * bc * half;
    weights[2] = cv::v_setzero_f32() - at * c * half;
    weights[3] = at * b * sixth;
  };
  const v_float32x4 lanes(0, 1, 2, 3);
  for (int r = 0; r < kRows; ++r) {
    for (int c = 0; c < kOutput; c += 4) {
      const cv::Point2f first = place(c, r);
      const v_float32x4 x =
          cv::v_fma(cv::v_setall_f32(source_from_patch(0, 0)), lanes, cv::v_setall_f32(first.x));
      const v_float32x4 y =
          cv::v_fma(cv::v_setall_f32(source_from_patch(1, 0)), lanes, cv::v_setall_f32(first.y));
      const cv::v_int32x4 whole_x = cv::v_trunc(x), whole_y = cv::v_trunc(y);  // positive: floors
      v_float32x4 wx[4], wy[4];
      weigh(x - cv::v_cvt_f32(whole_x), wx);
      weigh(y - cv::v_cvt_f32(whole_y), wy);
      v_float32x4 wx_of[4], weighted[4];  // a vector a sample
      cv::v_transpose4x4(wx[0], wx[1], wx[2], wx[3], wx_of[0], wx_of[1], wx_of[2], wx_of[3]);
      alignas(16) float wy_of[4][4];
      for (int k = 0; k < 4; ++k) cv::v_store_aligned(wy_of[k], wy[k]);
      alignas(16) int at_x[4], at_y[4];
      cv::v_store_aligned(at_x, whole_x);
      cv::v_store_aligned(at_y, whole_y);
      for (int i = 0; i < 4; ++i) {
        const uint8_t* pixels = grey.ptr(at_y[i] - 1) + at_x[i] - 1;
        v_float32x4 sum = cv::v_setzero_f32();
        for (int k = 0; k < 4; ++k, pixels += grey.step) {
          sum =
              cv::v_fma(cv::v_setall_f32(wy_of[k][i]),
                        cv::v_cvt_f32(cv::v_reinterpret_as_s32(cv::v_load_expand_q(pixels))), sum);
        }
        weighted[i] = sum * wx_of[i];
      }
      cv::v_store(samples + r * kOutput + c,
                  cv::v_reduce_sum4(weighted[0], weighted[1], weighted[2], weighted[3]));
    }
  }
  return true;
}

}  // namespace arfm_vo
