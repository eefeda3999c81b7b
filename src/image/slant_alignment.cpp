#include "arfm_vo/image/slant_alignment.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>

#include "patch_window.h"

namespace arfm_vo {
namespace {

constexpr int kSize = Patch::kSize;
/// A patch is not sheared anew where no sample would move by more.
constexpr float kMinShiftPx = 0.1f;
/// Rounds of measuring the slant and sampling the patch anew.
constexpr int kMaxRounds = 2;
/// Prior of each component of the disparity gradient.
constexpr double kGradientSigma = 0.2;
/// Of the samples, grey levels, against the prior.
constexpr double kNoiseGrey = 4;
/// A steeper surface is not believed.
constexpr double kMaxGradient = 0.8;

/// Left pixel steps of right pixel steps where the disparity has the given gradient.
cv::Matx22f LeftFromRight(const cv::Vec2f& disparity_gradient) {
  const float stretch = 1 / (1 - disparity_gradient[0]);
  return {stretch, disparity_gradient[1] * stretch, 0, 1};
}

cv::Vec2f DisparityGradient(const cv::Matx22f& left_from_right) {
  return {1 - 1 / left_from_right(0, 0), left_from_right(0, 1) / left_from_right(0, 0)};
}

/// By how much what `right` shows around `position` is stretched and sheared against the patch.
cv::Vec2f MeasureShear(const Patch& patch, const cv::Mat& right, const cv::Point2f& position) {
  Patch::Samples samples;
  const cv::Point2f corner = position - cv::Point2f(Patch::kHalfSpan, Patch::kHalfSpan);
  if (!ChoosePatchKernels().interpolate(View(right), corner.x, corner.y, samples.data())) {
    return {0, 0};
  }
  const float gain = Dot(patch.values, samples) / patch.squared_values;
  if (!(gain > 0)) return {0, 0};
  // right(x, y) = left(x + t + a x + b y): regressors g, g x, g y besides brightness and contrast.
  const Patch::Samples& g = patch.raw_gradient_x;
  Patch::Samples gx, gy;
  for (int r = 0; r < kSize; ++r) {
    for (int c = 0; c < kSize; ++c) {
      const int i = r * kSize + c;
      gx[i] = g[i] * (static_cast<float>(c) - Patch::kHalfSpan);
      gy[i] = g[i] * (static_cast<float>(r) - Patch::kHalfSpan);
    }
  }
  const std::array<const Patch::Samples*, 3> regressors = {&g, &gx, &gy};
  std::array<Patch::Samples, 3> weighted;
  std::array<float, 3> along_values;
  for (int k = 0; k < 3; ++k) {
    const float mean = Dot(kPatchWindow.weights, *regressors[k]);
    for (int i = 0; i < Patch::kNumSamples; ++i) {
      weighted[k][i] = kPatchWindow.weights[i] * ((*regressors[k])[i] - mean);
    }
    along_values[k] = Dot(patch.values, *regressors[k]);
  }
  // Sums are means under the window: the prior counts in the same unit.
  const auto prior = static_cast<float>(kNoiseGrey * kNoiseGrey * kPatchWindow.squared_sum /
                                        (kGradientSigma * kGradientSigma));
  cv::Matx33f normal;
  cv::Vec3f right_side;
  const float samples_along_values = Dot(patch.values, samples);
  for (int k = 0; k < 3; ++k) {
    const float share = along_values[k] / patch.squared_values;
    for (int l = 0; l <= k; ++l) {
      normal(k, l) = normal(l, k) = Dot(weighted[k], *regressors[l]) - share * along_values[l];
    }
    right_side[k] = (Dot(weighted[k], samples) - share * samples_along_values) / gain;
  }
  normal(0, 0) += 1e-6f;
  normal(1, 1) += prior;
  normal(2, 2) += prior;
  const cv::Vec3f solution = normal.solve(right_side, cv::DECOMP_CHOLESKY);
  return {solution[1], solution[2]};
}

}  // namespace

SlantAlignment AlignSlanted(const cv::Mat& left, const cv::Point2f& centre, const cv::Mat& right,
                            const cv::Point2f& guess, const PatchAlignmentLimits& limits) {
  SlantAlignment best;
  const auto upright = Patch::Sample(left, centre);
  if (!upright) {
    best.alignment.status = AlignmentStatus::kOutOfImage;
    return best;
  }
  Patch patch = *upright;
  best.alignment = AlignPatch(patch, right, guess, limits);
  cv::Matx22f left_from_right = cv::Matx22f::eye();
  cv::Point2f position = best.alignment.position;
  for (int round = 0; round < kMaxRounds; ++round) {
    // Where the first alignment failed the slant may be why; its last position is a start.
    const cv::Vec2f shear = MeasureShear(patch, right, position);
    left_from_right = left_from_right * cv::Matx22f(1 + shear[0], shear[1], 0, 1);
    const cv::Vec2f gradient = DisparityGradient(left_from_right);
    if (!(std::max(std::abs(gradient[0]), std::abs(gradient[1])) < kMaxGradient)) break;
    if (Patch::kHalfSpan * (std::abs(shear[0]) + std::abs(shear[1])) < kMinShiftPx) {
      best.disparity_gradient = gradient;
      break;
    }
    const auto slanted = Patch::Sample(left, centre, LeftFromRight(gradient));
    if (!slanted) break;
    patch = *slanted;
    const PatchAlignment alignment = AlignPatch(patch, right, position, limits);
    if (!alignment.IsAligned()) break;
    if (cv::norm(alignment.position - guess) > limits.max_shift_px) break;
    if (best.alignment.IsAligned() && alignment.zncc < best.alignment.zncc) break;
    best = {alignment, gradient};
    position = alignment.position;
  }
  return best;
}

}  // namespace arfm_vo
