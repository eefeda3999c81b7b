#include "arfm_vo/image/patch_alignment.h"

#include <algorithm>
#include <cmath>

#include "patch_window.h"
#include "symmetric.h"

namespace arfm_vo {
namespace {

const cv::Point2f kToCorner(Patch::kHalfSpan, Patch::kHalfSpan);

/// The image must have at least this share of the patch's contrast, and not the opposite one.
constexpr float kMinGain = 0.1f;

/// The last step is shorter than this.
constexpr double kConvergencePx = 0.02;

/// Brightness, contrast and translation are fitted to the samples.
constexpr float kNumParameters = 4;

float Length(const cv::Point2f& vector) {
  return std::sqrt(vector.x * vector.x + vector.y * vector.y);
}

float WeightedVariance(const Patch::Samples& samples) {
  return ChoosePatchKernels().weighted_variance(kPatchWindow.weights.data(), samples.data());
}

/// Sets what the samples at the aligned position tell, and the status by it.
void Judge(const Patch& patch, const Patch::Samples& samples, float gain,
           const cv::Vec3f& inverse_hessian, const PatchAlignmentLimits& limits,
           PatchAlignment& alignment) {
  const float variance = WeightedVariance(samples);
  alignment.zncc = gain * std::sqrt(patch.squared_values / variance);
  const float num_samples = 1 / kPatchWindow.squared_sum;
  const float squared_residual = std::max(0.0f, variance / (gain * gain) - patch.squared_values) *
                                 num_samples / (num_samples - kNumParameters);
  alignment.residual_rms = std::sqrt(squared_residual);
  alignment.covariance = squared_residual * Sandwich(inverse_hessian, patch.squared_gradients);
  const auto max_variance = static_cast<float>(limits.max_sigma_px * limits.max_sigma_px);
  if (!(alignment.zncc >= limits.min_zncc)) {
    alignment.status = AlignmentStatus::kLowCorrelation;
  } else if (!(std::max(alignment.covariance[0], alignment.covariance[2]) <= max_variance)) {
    alignment.status = AlignmentStatus::kLowTexture;
  } else {
    alignment.status = AlignmentStatus::kAligned;
  }
}

}  // namespace

PatchAlignment AlignPatch(const Patch& patch, const cv::Mat& grey, const cv::Point2f& guess,
                          const PatchAlignmentLimits& limits) {
  const cv::Vec3f inverse_hessian = InvertSymmetric(patch.hessian);
  PatchAlignment alignment;
  const auto stop = [&](AlignmentStatus status) {
    alignment.status = status;
    return alignment;
  };
  if (!std::isfinite(inverse_hessian[0])) return stop(AlignmentStatus::kLowTexture);
  alignment.position = guess;
  const PatchKernels& kernels = ChoosePatchKernels();
  const GreyView view = View(grey);
  Patch::Samples samples;
  while (alignment.num_iterations < limits.max_iterations) {
    ++alignment.num_iterations;
    const cv::Point2f corner = alignment.position - kToCorner;
    if (!kernels.interpolate(view, corner.x, corner.y, samples.data())) {
      return stop(AlignmentStatus::kOutOfImage);
    }
    float sums[3];
    kernels.dot_three(patch.values.data(), patch.gradient_x.data(), patch.gradient_y.data(),
                      samples.data(), sums);
    const float gain = sums[0] / patch.squared_values;
    if (!(gain > kMinGain)) return stop(AlignmentStatus::kLowCorrelation);
    const float x = sums[1] / gain, y = sums[2] / gain;
    const cv::Point2f step(inverse_hessian[0] * x + inverse_hessian[1] * y,
                           inverse_hessian[1] * x + inverse_hessian[2] * y);
    alignment.position -= step;
    if (!(Length(alignment.position - guess) <= limits.max_shift_px)) {
      return stop(AlignmentStatus::kMovedTooFar);
    }
    if (Length(step) < kConvergencePx) {
      Judge(patch, samples, gain, inverse_hessian, limits, alignment);
      return alignment;
    }
  }
  return stop(AlignmentStatus::kNotConverged);
}

}  // namespace arfm_vo
