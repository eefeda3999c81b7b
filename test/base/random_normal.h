#pragma once

#include <Eigen/Core>
#include <cmath>

#include "arfm_vo/base/random.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// A standard normal number (Box and Muller 1958), the same on every platform.
inline double RandomNormal(RandomEngine& engine) {
  const double radius = std::sqrt(-2 * std::log(1 - RandomUnit(engine)));
  return radius * std::cos(2 * M_PI * RandomUnit(engine));
}
inline Eigen::Vector3d RandomNormal3(RandomEngine& engine) {
  const double x = RandomNormal(engine), y = RandomNormal(engine);
  return {x, y, RandomNormal(engine)};
}

/// The step (rad, m) of BoxPlus that leads from the true pose to the estimate.
inline Eigen::Matrix<double, 6, 1> StepBetween(const Rigid3& truth, const Rigid3& estimate) {
  const Rigid3 difference = estimate * truth.Inverse();
  Eigen::Matrix<double, 6, 1> step;
  step << LogSO3(difference.rotation), difference.translation;
  return step;
}

}  // namespace arfm_vo
