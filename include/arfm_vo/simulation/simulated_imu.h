#pragma once

#include <cmath>
#include <optional>
#include <utility>

#include "arfm_vo/base/random.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// The gyro of a cheap IMU whose axes are those of the base: white noise of 2e-4 rad/s per root of
/// Hz, and a bias of 0.01 rad/s about each axis.
class SimulatedImu {
 public:
  explicit SimulatedImu(int seed = 1) : engine_(seed) {}

  /// The mean rate since the reading before, rad/s, seen from the base; nothing at the first.
  std::optional<Eigen::Vector3d> Read(double now_s, const Eigen::Quaterniond& world_from_base) {
    constexpr double kNoise = 2e-4, kBias_rad_s = 0.01;
    const auto before = std::exchange(world_from_before_, world_from_base);
    const double interval_s = now_s - std::exchange(before_s_, now_s);
    if (!before) return std::nullopt;
    Eigen::Vector3d rate = LogSO3(before->conjugate() * world_from_base) / interval_s;
    for (int axis = 0; axis < 3; ++axis) {
      rate[axis] += kBias_rad_s + kNoise / std::sqrt(interval_s) * RandomDeviate(engine_);
    }
    return rate;
  }

 private:
  RandomEngine engine_;
  std::optional<Eigen::Quaterniond> world_from_before_;
  double before_s_ = 0;
};

}  // namespace arfm_vo
