#pragma once

#include <cstdint>

namespace arfm_vo {

/// An 8 bit grey image.
struct GreyView {
  const uint8_t* pixels;
  int64_t step;  ///< bytes from row to row
  int rows, cols;
};

constexpr int kPatchSize = 12;                 ///< samples a side
constexpr int kBorderedSize = kPatchSize + 2;  ///< with a border of one for the gradients
constexpr int kPatchSamples = kPatchSize * kPatchSize;
constexpr int kBorderedSamples = kBorderedSize * kBorderedSize;

/// What a Patch keeps of its samples; kPatchSamples each.
struct PatchParts {
  float *values, *gradient_x, *gradient_y, *raw_gradient_x;
};

/// The sums of a Patch.
struct PatchSums {
  float squared_values = 0;
  float hessian[3] = {};
  float squared_gradients[3] = {};
};

/// The loops over samples, for one instruction set. All give the same bits.
struct PatchKernels {
  /// Interpolates kPatchSamples samples 1 px apart, the first at (x, y). False where they or the
  /// pixels around them lie outside the image.
  bool (*interpolate)(const GreyView& grey, float x, float y, float* samples);
  /// The same for kBorderedSamples.
  bool (*interpolate_bordered)(const GreyView& grey, float x, float y, float* samples);
  /// Interpolates kBorderedSamples samples at (x, y) + [a b; c d] * (column, row), columns and rows
  /// counted from the middle of the square.
  bool (*interpolate_warped)(const GreyView& grey, float x, float y, const float abcd[4],
                             float* samples);
  /// Fills the parts of a patch from kBorderedSamples samples.
  PatchSums (*prepare)(const float* bordered, const float* weights, const PatchParts& parts);
  /// Sum of products of kPatchSamples values.
  float (*dot)(const float* a, const float* b);
  /// Three sums of products with the same samples.
  void (*dot_three)(const float* a, const float* b, const float* c, const float* samples,
                    float sums[3]);
  /// Variance of the samples under weights whose sum is one.
  float (*weighted_variance)(const float* weights, const float* samples);
};

extern const PatchKernels kPatchKernelsBaseline;
extern const PatchKernels kPatchKernelsAvx2;
/// The best for this CPU.
const PatchKernels& ChoosePatchKernels();

}  // namespace arfm_vo
