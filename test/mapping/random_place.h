#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/matching/appearance.h"

namespace arfm_vo {

/// A point before a camera that stands in a place, and its looks.
struct RandomPoint {
  Eigen::Vector3d x_in_place;
  std::vector<float> descriptor;  ///< [64] unit
  int8_t sign;

  /// A little changed, as from aside.
  Appearance LookAgain(RandomEngine& engine) const {
    std::vector<float> changed = descriptor;
    for (float& value : changed) value += static_cast<float>(0.04 * RandomUnit(engine) - 0.02);
    Eigen::Map<Eigen::VectorXf>(changed.data(), 64).normalize();
    return {changed.data(), sign};
  }
};

constexpr int kPoints = 120;  ///< of a place

inline std::vector<RandomPoint> MakeRandomPlace(RandomEngine& engine) {
  const auto between = [&](double low, double high) {
    return low + (high - low) * RandomUnit(engine);
  };
  std::vector<RandomPoint> place;
  for (int i = 0; i < kPoints; ++i) {
    const double x = between(-3, 3), y = between(-2, 2), z = between(4, 9);
    RandomPoint point{{x, y, z}, std::vector<float>(64), static_cast<int8_t>(i % 2 == 0 ? 1 : -1)};
    for (float& value : point.descriptor) value = static_cast<float>(between(-1, 1));
    Eigen::Map<Eigen::VectorXf>(point.descriptor.data(), 64).normalize();
    place.push_back(point);
  }
  return place;
}

}  // namespace arfm_vo
