#pragma once

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/planar_motion.h"
#include "arfm_vo/driving/track_history.h"

namespace arfm_vo {

struct StopLookGoOptions {
  bool is_on = false;          ///< drive in steps and stand still for each look
  double step_m = 0.25;        ///< way of the faster track between two looks
  double max_pose_age_s = 60;  ///< takes the place of pose.max_pose_age_s

  void Check() const;
  ARFM_FIELDS(is_on, step_m, max_pose_age_s)
};

/// Driving for a slow computer: a step by the track odometer, a stop, a look at the scene at rest,
/// the next step.
class StopLookGo {
 public:
  explicit StopLookGo(const StopLookGoOptions& options) : options_(options) { options_.Check(); }

  /// `wanted` within a step, and nothing from its end until the rover has settled and has seen a
  /// pose since (`is_at_rest`). Switched off, always `wanted`.
  PlanarMotion Gate(const PlanarMotion& wanted, const TrackWays& ways, bool is_at_rest);

  /// The next motion needs a look first.
  void Reset() { is_looking_ = true; }

 private:
  StopLookGoOptions options_;
  bool is_looking_ = true;
  TrackWays step_start_;
};

}  // namespace arfm_vo
