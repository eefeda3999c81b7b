#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace arfm_vo {

/// What a point looks like, as it is kept for long: the blob's sign, and its descriptor in steps of
/// 1 / 127 (64 bytes instead of 256; distances are true to about 0.02).
struct Appearance {
  static constexpr int kLength = 64;
  static constexpr float kSteps = 127;  ///< in 1

  std::array<int8_t, kLength> descriptor{};  ///< steps
  int8_t laplacian_sign = 1;                 ///< as Keypoint has it

  Appearance() = default;
  /// Of a descriptor [64] of unit length.
  Appearance(const float* unit_descriptor, int8_t laplacian_sign) : laplacian_sign(laplacian_sign) {
    for (int i = 0; i < kLength; ++i) {
      const float x = std::clamp(unit_descriptor[i], -1.0f, 1.0f);
      descriptor[i] = static_cast<int8_t>(std::lround(kSteps * x));
    }
  }

  /// Squared distance of the descriptors, 0..4; infinite where one blob is dark and one is bright
  /// (never the same point, Bay 2008, section 4.3).
  float SquaredDistance(const Appearance& other) const {
    if (laplacian_sign != other.laplacian_sign) return std::numeric_limits<float>::infinity();
    int sum = 0;
    for (int i = 0; i < kLength; ++i) {
      const auto difference = static_cast<int16_t>(descriptor[i] - other.descriptor[i]);
      sum += difference * difference;
    }
    return static_cast<float>(sum) / (kSteps * kSteps);
  }
};

}  // namespace arfm_vo
