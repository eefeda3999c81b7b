#pragma once

#include <array>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/matx.hpp>
#include <opencv2/core/types.hpp>
#include <optional>

namespace arfm_vo {

/// A small square of grey values around a point, prepared for alignment with other images; it can
/// be kept with a landmark without its image.
struct Patch {
  static constexpr int kSize = 12;  ///< samples a side; the point lies in the middle
  static constexpr int kNumSamples = kSize * kSize;
  static constexpr float kHalfSpan = 0.5f * (kSize - 1);
  using Samples = std::array<float, kNumSamples>;

  /// Samples `grey` (CV_8UC1) with cubic interpolation at centre + source_from_patch * (i - 5.5, j
  /// - 5.5). With the identity, samples are 1 px apart; for a landmark now seen larger by a factor
  /// f, pass 1 / f. Nothing where a sample lies outside the image.
  static std::optional<Patch> Sample(const cv::Mat& grey, const cv::Point2f& centre,
                                     const cv::Matx22f& source_from_patch = cv::Matx22f::eye());

  // What neither brightness nor contrast explains: all three are orthogonal to a constant, and the
  // gradients to the values, under the window, whose weights w are multiplied in.
  alignas(32) Samples values;
  alignas(32) Samples gradient_x;
  alignas(32) Samples gradient_y;
  alignas(32) Samples raw_gradient_x;  ///< as it is
  float squared_values = 0;            ///< sum of w value^2
  cv::Vec3f hessian;                   ///< sums of w gx^2, w gx gy, w gy^2
  cv::Vec3f squared_gradients;         ///< the same with w^2
};

}  // namespace arfm_vo
