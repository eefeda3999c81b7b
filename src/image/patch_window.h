#pragma once

#include "arfm_vo/image/patch.h"
#include "patch_kernels.h"

namespace arfm_vo {

/// A Gaussian window, so that what lies near a patch's point counts most.
struct PatchWindow {
  alignas(32) Patch::Samples weights;  ///< sum to one
  float squared_sum = 0;               ///< of the weights: one over the effective number of samples

  PatchWindow();
};
extern const PatchWindow kPatchWindow;

inline GreyView View(const cv::Mat& grey) {
  return {grey.data, static_cast<int64_t>(grey.step), grey.rows, grey.cols};
}

/// Sum of products.
inline float Dot(const Patch::Samples& a, const Patch::Samples& b) {
  return ChoosePatchKernels().dot(a.data(), b.data());
}

}  // namespace arfm_vo
