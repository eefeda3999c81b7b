#include "arfm_vo/image/patch.h"

#include <cmath>

#include "arfm_vo/base/check.h"
#include "patch_window.h"

namespace arfm_vo {
namespace {

static_assert(Patch::kSize == kPatchSize && Patch::kNumSamples == kPatchSamples);
constexpr int kSize = Patch::kSize;
constexpr double kWindowSigmaPx = 3.5;

bool SampleBordered(const GreyView& grey, const cv::Point2f& centre,
                    const cv::Matx22f& source_from_patch, float* samples) {
  constexpr float kBorderedHalfSpan = 0.5f * (kBorderedSize - 1);
  const PatchKernels& kernels = ChoosePatchKernels();
  if (source_from_patch == cv::Matx22f::eye()) {
    return kernels.interpolate_bordered(grey, centre.x - kBorderedHalfSpan,
                                        centre.y - kBorderedHalfSpan, samples);
  }
  return kernels.interpolate_warped(grey, centre.x, centre.y, source_from_patch.val, samples);
}

}  // namespace

PatchWindow::PatchWindow() {
  double sum = 0;
  for (int i = 0; i < Patch::kNumSamples; ++i) {
    const int row = i / kSize, column = i % kSize;
    const double x = static_cast<float>(column) - Patch::kHalfSpan;
    const double y = static_cast<float>(row) - Patch::kHalfSpan;
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
  float bordered[kBorderedSamples];
  if (!SampleBordered(View(grey), centre, source_from_patch, bordered)) return std::nullopt;
  Patch patch;
  const PatchSums sums =
      ChoosePatchKernels().prepare(bordered, kPatchWindow.weights.data(),
                                   {patch.values.data(), patch.gradient_x.data(),
                                    patch.gradient_y.data(), patch.raw_gradient_x.data()});
  patch.squared_values = sums.squared_values;
  patch.hessian = cv::Vec3f(sums.hessian);
  patch.squared_gradients = cv::Vec3f(sums.squared_gradients);
  return patch;
}

}  // namespace arfm_vo
