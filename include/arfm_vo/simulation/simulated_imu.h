#pragma once

#include <Eigen/Core>
#include <cmath>
#include <optional>
#include <utility>

#include "arfm_vo/base/random.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// What an IMU reads, seen from the base.
struct ImuReading {
  Eigen::Vector3d rate_rad_s;
  Eigen::Vector3d force_m_s2;  ///< specific force: gravity's reaction, up, and the acceleration
};

/// A cheap IMU whose axes are those of the base, which is where it sits: white noise of 2e-4 rad/s
/// and 2e-3 m/s^2 per root of Hz, and a bias of 0.01 rad/s and 0.1 m/s^2 in each axis.
class SimulatedImu {
 public:
  explicit SimulatedImu(int seed = 1) : engine_(seed) {}

  /// The mean since the reading before; nothing at the first two.
  std::optional<ImuReading> Read(double now_s, const Rigid3& world_from_base) {
    constexpr double kRateNoise = 2e-4, kRateBias_rad_s = 0.01;
    constexpr double kForceNoise = 2e-3, kForceBias_m_s2 = 0.1, kGravity_m_s2 = 9.81;
    const auto before = std::exchange(world_from_before_, world_from_base);
    const double interval_s = now_s - std::exchange(before_s_, now_s);
    if (!before) return std::nullopt;
    const Eigen::Vector3d velocity =
        (world_from_base.translation - before->translation) / interval_s;
    const auto velocity_before = std::exchange(velocity_, velocity);
    if (!velocity_before) return std::nullopt;
    const Eigen::Vector3d force =
        (velocity - *velocity_before) / interval_s + kGravity_m_s2 * Eigen::Vector3d::UnitZ();
    ImuReading reading{LogSO3(before->rotation.conjugate() * world_from_base.rotation) / interval_s,
                       world_from_base.rotation.conjugate() * force};
    const double root_s = std::sqrt(interval_s);
    for (int axis = 0; axis < 3; ++axis) {
      reading.rate_rad_s[axis] += kRateBias_rad_s + kRateNoise / root_s * RandomDeviate(engine_);
      reading.force_m_s2[axis] += kForceBias_m_s2 + kForceNoise / root_s * RandomDeviate(engine_);
    }
    return reading;
  }

 private:
  RandomEngine engine_;
  std::optional<Rigid3> world_from_before_;
  std::optional<Eigen::Vector3d> velocity_;
  double before_s_ = 0;
};

}  // namespace arfm_vo
