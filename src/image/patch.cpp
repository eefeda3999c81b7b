#include "arfm_vo/image/patch.h"

#include <cmath>

#include "arfm_vo/base/check.h"
#include "cubic_interpolation.h"
#include "patch_window.h"
#include "symmetric.h"

namespace arfm_vo {
namespace {

constexpr int kSize = Patch::kSize;
constexpr double kWindowSigmaPx = 3.5;
using Samples = Patch::Samples;

/// A patch's samples with a border of one for the gradients.
constexpr int kBordered = kSize + 2;
constexpr int kBorderedStride = PaddedToVectors(kBordered);
using BorderedSamples = std::array<float, kBordered * kBorderedStride>;

bool SampleBordered(const cv::Mat& grey, const cv::Point2f& centre,
                    const cv::Matx22f& source_from_patch, BorderedSamples& samples) {
  constexpr float kBorderedHalfSpan = 0.5f * (kBordered - 1);
  if (source_from_patch == cv::Matx22f::eye()) {
    return Interpolate<kBordered, kBordered>(
        grey, centre - cv::Point2f(kBorderedHalfSpan, kBorderedHalfSpan), samples.data());
  }
  return InterpolateWarped<kBordered, kBordered>(grey, centre, source_from_patch, samples.data());
}

Samples Weighted(const Samples& values) {
  Samples weighted;
  for (int i = 0; i < Patch::kNumSamples; ++i) weighted[i] = kPatchWindow.weights[i] * values[i];
  return weighted;
}

void SubtractMultiple(Samples& from, float factor, const Samples& what) {
  for (int i = 0; i < Patch::kNumSamples; ++i) from[i] -= factor * what[i];
}

void SubtractConstant(Samples& from, float constant) {
  for (float& value : from) value -= constant;
}

/// Central differences inside the border.
void Differentiate(const BorderedSamples& bordered, Samples& values, Samples& gradient_x,
                   Samples& gradient_y) {
  for (int r = 0; r < kSize; ++r) {
    for (int c = 0; c < kSize; ++c) {
      const float* at = &bordered[(r + 1) * kBorderedStride + c + 1];
      values[r * kSize + c] = at[0];
      gradient_x[r * kSize + c] = 0.5f * (at[1] - at[-1]);
      gradient_y[r * kSize + c] = 0.5f * (at[kBorderedStride] - at[-kBorderedStride]);
    }
  }
}

}  // namespace

PatchWindow::PatchWindow() {
  double sum = 0;
  for (int i = 0; i < Patch::kNumSamples; ++i) {
    const double x = i % kSize - Patch::kHalfSpan, y = i / kSize - Patch::kHalfSpan;
    weights[i] =
        static_cast<float>(std::exp(-0.5 * (x * x + y * y) / (kWindowSigmaPx * kWindowSigmaPx)));
    sum += weights[i];
  }
  for (float& weight : weights) {
    weight = static_cast<float>(weight / sum);
    squared_sum += weight * weight;
  }
}

const PatchWindow kPatchWindow;

std::optional<Patch> Patch::Sample(const cv::Mat& grey, const cv::Point2f& centre,
                                   const cv::Matx22f& source_from_patch) {
  Require(grey.type() == CV_8UC1, "patch: the image must be 8 bit grey");
  BorderedSamples bordered;
  if (!SampleBordered(grey, centre, source_from_patch, bordered)) return std::nullopt;
  Samples values, gradient_x, gradient_y;
  Differentiate(bordered, values, gradient_x, gradient_y);
  const Samples& weights = kPatchWindow.weights;
  SubtractConstant(values, Dot(weights, values));
  Patch patch;
  patch.raw_gradient_x_ = gradient_x;
  patch.values_ = Weighted(values);
  patch.squared_values_ = Dot(patch.values_, values);
  if (patch.squared_values_ > 0) {
    for (Samples* gradient : {&gradient_x, &gradient_y}) {
      SubtractConstant(*gradient, Dot(weights, *gradient));
      SubtractMultiple(*gradient, Dot(patch.values_, *gradient) / patch.squared_values_, values);
    }
  }
  patch.gradient_x_ = Weighted(gradient_x);
  patch.gradient_y_ = Weighted(gradient_y);
  patch.hessian_ = {Dot(patch.gradient_x_, gradient_x), Dot(patch.gradient_x_, gradient_y),
                    Dot(patch.gradient_y_, gradient_y)};
  patch.squared_gradients_ = {Dot(patch.gradient_x_, patch.gradient_x_),
                              Dot(patch.gradient_x_, patch.gradient_y_),
                              Dot(patch.gradient_y_, patch.gradient_y_)};
  return patch;
}

cv::Vec3f Patch::UnitCovariance() const {
  return Sandwich(InvertSymmetric(hessian_), squared_gradients_);
}

}  // namespace arfm_vo
