#pragma once

namespace arfm_vo {

/// Squared Euclidean distance of two descriptors of 64 floats.
inline float SquaredDescriptorDistance(const float* a, const float* b) {
  constexpr int kLanes = 16;  // independent sums, so that the compiler may vectorise
  float sums[kLanes] = {};
  for (int k = 0; k < 64; k += kLanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const float difference = a[k + lane] - b[k + lane];
      sums[lane] += difference * difference;
    }
  }
  for (int width = kLanes / 2; width > 0; width /= 2) {
    for (int lane = 0; lane < width; ++lane) sums[lane] += sums[lane + width];
  }
  return sums[0];
}

}  // namespace arfm_vo
