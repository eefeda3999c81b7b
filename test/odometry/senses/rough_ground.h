#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/simulation/tracked_plant.h"

namespace arfm_vo {

/// A rover on ground of hills 3 to 12 m long, whose slopes have this standard deviation.
inline PlaceOnGround RoughGround(double slope_rad, int seed) {
  struct Wave {
    Eigen::Vector2d number;  ///< rad/m
    double height_m, phase;
  };
  RandomEngine engine(seed);
  std::vector<Wave> waves;
  constexpr int kNumWaves = 12;
  for (int i = 0; i < kNumWaves; ++i) {
    const double number = 2 * M_PI / (3 + 9. * i / (kNumWaves - 1));
    const double direction = 2 * M_PI * RandomUnit(engine);
    waves.push_back({number * Eigen::Vector2d(std::cos(direction), std::sin(direction)),
                     2 * slope_rad / std::sqrt(1. * kNumWaves) / number,
                     2 * M_PI * RandomUnit(engine)});
  }
  return [waves](const RoverPose& pose) {
    double height_m = 0;
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    for (const Wave& wave : waves) {
      const double phase = wave.number.dot(Eigen::Vector2d(pose.x_m, pose.y_m)) + wave.phase;
      height_m += wave.height_m * std::sin(phase);
      slope += wave.height_m * std::cos(phase) * wave.number;
    }
    const Eigen::Vector3d up = Eigen::Vector3d(-slope.x(), -slope.y(), 1).normalized();
    const Eigen::Vector3d heading(std::cos(pose.heading_rad), std::sin(pose.heading_rad), 0);
    const Eigen::Vector3d left = up.cross(heading).normalized();
    Eigen::Matrix3d rotation;
    rotation << left.cross(up), left, up;
    return Rigid3(rotation, Eigen::Vector3d(pose.x_m, pose.y_m, height_m));
  };
}

}  // namespace arfm_vo
