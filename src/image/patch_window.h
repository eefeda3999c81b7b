#pragma once

#include <opencv2/core/hal/intrin.hpp>

#include "arfm_vo/image/patch.h"

namespace arfm_vo {

/// A Gaussian window, so that what lies near a patch's point counts most.
struct PatchWindow {
  alignas(32) Patch::Samples weights;  ///< sum to one
  float squared_sum = 0;               ///< of the weights: one over the effective number of samples

  PatchWindow();
};
extern const PatchWindow kPatchWindow;

/// Sum of products.
inline float Dot(const Patch::Samples& a, const Patch::Samples& b) {
  cv::v_float32x4 sums[4];  // four sums hide the latency of the additions
  for (auto& sum : sums) sum = cv::v_setzero_f32();
  for (int i = 0; i < Patch::kNumSamples; i += 16) {
    for (int k = 0; k < 4; ++k) {
      sums[k] = cv::v_fma(cv::v_load(&a[i + 4 * k]), cv::v_load(&b[i + 4 * k]), sums[k]);
    }
  }
  return cv::v_reduce_sum((sums[0] + sums[1]) + (sums[2] + sums[3]));
}

}  // namespace arfm_vo
