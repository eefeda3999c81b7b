#pragma once

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/range_check.h"
#include "arfm_vo/driving/planar_motion.h"

namespace arfm_vo {

struct TrackKinematicsOptions {
  double gauge_m = 0.583;  ///< from the middle of one track to that of the other
  /// How many times faster than the base the tracks must turn, since they skid sideways (>= 1 on
  /// real ground; the ratio of effective to real gauge).
  double turn_slip_factor = 1.0;

  void Check() const {
    Require(gauge_m > 0.01 && gauge_m < 10, "kinematics.gauge_m must be in (0.01, 10)");
    RequireInRange(turn_slip_factor, 0.2, 5, "kinematics.turn_slip_factor");
  }
  ARFM_FIELDS(gauge_m, turn_slip_factor)
};

/// Skid steering: what the tracks must do for the base to move as wanted, and the other way round.
class TrackKinematics {
 public:
  explicit TrackKinematics(const TrackKinematicsOptions& options) : options_(options) {
    options_.Check();
  }

  /// The track speeds that move the base as `motion`.
  TrackSpeeds TracksFor(const PlanarMotion& motion) const {
    const double half_difference = motion.turn_radps * EffectiveGauge() / 2;
    return {motion.forward_mps - half_difference, motion.forward_mps + half_difference};
  }
  /// The motion of the base that `tracks` (speeds, or ways) bring on ground without forward slip.
  PlanarMotion MotionOf(const TrackSpeeds& tracks) const {
    return {(tracks.left_mps + tracks.right_mps) / 2,
            (tracks.right_mps - tracks.left_mps) / EffectiveGauge()};
  }
  /// `motion` of the base as the chassis must be told it: it takes turns to be free of slip.
  PlanarMotion ChassisMotionFor(const PlanarMotion& motion) const {
    return {motion.forward_mps, motion.turn_radps * options_.turn_slip_factor};
  }
  /// The motion of the base where the chassis, which takes turns to be free of slip, says `motion`.
  PlanarMotion MotionFromChassis(const PlanarMotion& motion) const {
    return {motion.forward_mps, motion.turn_radps / options_.turn_slip_factor};
  }
  /// The speed of the faster track, m/s.
  double FasterTrack(const PlanarMotion& motion) const {
    return std::abs(motion.forward_mps) + std::abs(motion.turn_radps) * EffectiveGauge() / 2;
  }

 private:
  double EffectiveGauge() const { return options_.gauge_m * options_.turn_slip_factor; }

  TrackKinematicsOptions options_;
};

}  // namespace arfm_vo
