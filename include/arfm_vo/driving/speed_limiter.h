#pragma once

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/track_kinematics.h"

namespace arfm_vo {

/// The paper's limit, which no option can raise.
constexpr double kMaxSpeed_mps = 0.1;

constexpr double kMaxTurnRate_radps = 0.2;  ///< of the base

struct SpeedLimiterOptions {
  double max_speed_mps = kMaxSpeed_mps;       ///< of the base and of either track
  double max_acceleration_mps2 = 0.2;         ///< of the base
  double max_turn_acceleration_radps2 = 0.4;  ///< of the base

  void Check() const;
  ARFM_FIELDS(max_speed_mps, max_acceleration_mps2, max_turn_acceleration_radps2)
};

/// Keeps a motion within the limits of speed and acceleration. Where the faster track would exceed
/// the limit, forward speed and turn rate shrink together, so that the curve stays the same.
class SpeedLimiter {
 public:
  SpeedLimiter(const SpeedLimiterOptions& options, const TrackKinematics& kinematics);

  /// The motion nearest to `wanted` that is allowed `dt_s` after the last one. A wanted motion that
  /// is not finite is taken as standing still.
  PlanarMotion Limit(const PlanarMotion& wanted, double dt_s);

  /// Stands still at once, whatever the limits of acceleration.
  void Halt() { motion_ = {}; }

 private:
  PlanarMotion Shrink(PlanarMotion motion) const;

  SpeedLimiterOptions options_;
  TrackKinematics kinematics_;
  PlanarMotion motion_;
};

}  // namespace arfm_vo
