#pragma once

#include <cmath>
#include <limits>
#include <opencv2/core/matx.hpp>

namespace arfm_vo {

/// Inverse of a symmetric (xx, xy, yy); infinite on the diagonal where there is none.
inline cv::Vec3f InvertSymmetric(const cv::Vec3f& h) {
  const float determinant = h[0] * h[2] - h[1] * h[1];
  if (!(determinant > 1e-6f * h[0] * h[2])) {
    const float infinity = std::numeric_limits<float>::infinity();
    return {infinity, 0, infinity};
  }
  return {h[2] / determinant, -h[1] / determinant, h[0] / determinant};
}

/// a m a for symmetric matrices (xx, xy, yy); infinite where a is.
inline cv::Vec3f Sandwich(const cv::Vec3f& a, const cv::Vec3f& m) {
  if (!std::isfinite(a[0])) return a;
  const float p = a[0] * m[0] + a[1] * m[1], q = a[0] * m[1] + a[1] * m[2];
  const float r = a[1] * m[0] + a[2] * m[1], s = a[1] * m[1] + a[2] * m[2];
  return {p * a[0] + q * a[1], p * a[1] + q * a[2], r * a[1] + s * a[2]};
}

}  // namespace arfm_vo
