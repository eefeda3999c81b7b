#pragma once

#include <cstdint>

#include "arfm_vo/features/features.h"
#include "arfm_vo/image/integral_image.h"

namespace arfm_vo {

/// Second derivatives of an image by box filters of one size, not normalised. Whole numbers, hence
/// the same whatever the way they are summed.
struct BoxHessian {
  int32_t xx = 0, yy = 0, xy = 0;
};

/// Size in px (9, 15, 21, 27; 15, 27, 39, 51; ..) of the filter of a layer of an octave, from 0.
constexpr int BoxFilterSize(int octave, int layer) { return 3 * ((layer + 1) * (2 << octave) + 1); }

constexpr float ScaleOfFilter(float size) { return size * (kSmallestScale / 9.0f); }

/// At the pixel (x, y), for an odd multiple `size` of 3 with size / 2 pixels on each side of it.
BoxHessian ComputeBoxHessian(const IntegralImage& integral, int x, int y, int size);

/// Determinant of the Hessian, eq 3, of derivatives divided by the filter's area.
inline float ComputeDeterminant(const BoxHessian& sums, float inverse_area) {
  const float xx = static_cast<float>(sums.xx) * inverse_area;
  const float yy = static_cast<float>(sums.yy) * inverse_area;
  const float xy = static_cast<float>(sums.xy) * inverse_area;
  return xx * yy - (0.81f * xy) * xy;
}

}  // namespace arfm_vo
