#pragma once

#include <algorithm>
#include <cmath>

#include "region_window.h"

namespace arfm_vo {

// The samples of SURF-64.
constexpr int kDescriptorLength = 64;
constexpr int kOrientationRadius = 6;  ///< scales

inline bool IsInOrientationDisc(int i, int j) {
  return i * i + j * j < kOrientationRadius * kOrientationRadius;
}
/// Gaussian weight of a sample, as a whole number, so that sums do not depend on their order.
inline int OrientationWeight(int i, int j) {
  constexpr double kSigma = 2.5;
  return static_cast<int>(std::lround(256 * std::exp(-(i * i + j * j) / (2 * kSigma * kSigma))));
}
/// Half the edge of the Haar wavelets, px.
inline int OrientationHalf(float scale) { return static_cast<int>(std::lround(2 * scale)); }
inline int DescriptorHalf(float scale, const RegionWindow& window) {
  return std::max(1, static_cast<int>(std::lround(window.wavelet * scale)));
}

}  // namespace arfm_vo
