#include "arfm_vo/driving/speed_limiter.h"

#include <algorithm>

#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

double StepTowards(double from, double to, double max_step) {
  return from + std::clamp(to - from, -max_step, max_step);
}

}  // namespace

void SpeedLimiterOptions::Check() const {
  Require(max_speed_mps > 0 && max_speed_mps <= kMaxSpeed_mps,
          "limits.max_speed_mps must be in (0, 0.1]");
  RequireAbove(max_acceleration_mps2, 0, 10, "limits.max_acceleration_mps2");
  RequireAbove(max_turn_acceleration_radps2, 0, 100, "limits.max_turn_acceleration_radps2");
}

SpeedLimiter::SpeedLimiter(const SpeedLimiterOptions& options, const TrackKinematics& kinematics)
    : options_(options), kinematics_(kinematics) {
  options_.Check();
}

PlanarMotion SpeedLimiter::Shrink(PlanarMotion motion) const {
  motion.turn_radps = std::clamp(motion.turn_radps, -kMaxTurnRate_radps, kMaxTurnRate_radps);
  const double faster_mps = kinematics_.FasterTrack(motion);
  if (faster_mps <= options_.max_speed_mps) return motion;
  const double scale = options_.max_speed_mps / faster_mps;
  return {motion.forward_mps * scale, motion.turn_radps * scale};
}

PlanarMotion SpeedLimiter::Limit(const PlanarMotion& wanted, double dt_s) {
  const PlanarMotion target = wanted.IsFinite() ? Shrink(wanted) : PlanarMotion{};
  const double dt = std::max(dt_s, 0.0);
  motion_.forward_mps =
      StepTowards(motion_.forward_mps, target.forward_mps, options_.max_acceleration_mps2 * dt);
  motion_.turn_radps = StepTowards(motion_.turn_radps, target.turn_radps,
                                   options_.max_turn_acceleration_radps2 * dt);
  motion_ = Shrink(motion_);
  return motion_;
}

}  // namespace arfm_vo
