#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "arfm_vo/image/integral_image.h"

namespace arfm_vo {

/// Responses of the two Haar wavelets: right minus left half, lower minus upper half.
struct HaarResponse {
  int32_t dx = 0, dy = 0;
};

/// Of square wavelets with edges of 2 `half` px around the corner of pixels that is nearest to
/// (x, y), moved into the image where they do not fit; the image must be that large.
inline HaarResponse ComputeHaarResponse(const IntegralImage& integral, float x, float y, int half) {
  const int column =
      std::clamp(static_cast<int>(std::floor(x + 1.0f)), half, integral.cols() - half);
  const int row = std::clamp(static_cast<int>(std::floor(y + 1.0f)), half, integral.rows() - half);
  const int left = column - half, right = column + half, top = row - half, bottom = row + half;
  HaarResponse response;
  response.dx =
      integral.BoxSum(column, top, right, bottom) - integral.BoxSum(left, top, column, bottom);
  response.dy = integral.BoxSum(left, row, right, bottom) - integral.BoxSum(left, top, right, row);
  return response;
}

}  // namespace arfm_vo
