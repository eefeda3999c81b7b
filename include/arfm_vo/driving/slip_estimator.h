#pragma once

#include <deque>
#include <optional>
#include <string>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/driving/track_kinematics.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

struct SlipOptions {
  double max_slip_ratio = 0.5;   ///< of the way ahead; above it the rover stops
  double max_level_ratio = 0.2;  ///< the same over a longer way of level ground, and aside

  void Check() const;
  ARFM_FIELDS(max_slip_ratio, max_level_ratio)
};

/// Slip over the last window: (track - sight) / max(|track|, |sight|), 0 where they agree, 1 where
/// the tracks run and the rover stays, negative where it slides. A ratio is there only where the
/// tracks drove, or turned, enough in the window to judge.
struct Slip {
  std::optional<double> forward_ratio;
  std::optional<double> turn_ratio;
  std::optional<double>
      sideways_ratio;  ///< of sight: aside over ahead, where the tracks go straight
  double path_m = 0;   ///< of the tracks, mean of both, forth and back
  double sight_forward_m = 0, sight_sideways_m = 0, track_forward_m = 0;
  double sight_turn_rad = 0, track_turn_rad = 0;
};

/// Compares the way that the rover sees itself go with that of its tracks.
class SlipEstimator {
 public:
  SlipEstimator(const SlipOptions& options, const TrackKinematics& kinematics);

  /// Takes the next pose by sight, in a frame where it never jumps, and the ways of the tracks at
  /// the same time.
  void Add(const Rigid3& odom_from_base, const TrackWays& ways);

  /// Nothing until the first window is full.
  std::optional<Slip> Estimate() const;

  /// What tracks and sight disagree about, in words, where it is more than slip may be.
  std::optional<std::string> FindExcess() const;

  /// Forgets the windows, as after a stop.
  void Reset() {
    samples_.clear();
    level_since_m_ = 0;
  }

 private:
  struct Sample {
    Rigid3 odom_from_base;
    TrackWays ways;
    Slip sum;  // of the ways since the last reset
  };
  /// The last `window_m` of the tracks' way, but for its largest jump: slip goes on. Nothing where
  /// so much has not been driven.
  std::optional<Slip> Over(double window_m) const;
  /// The same; nothing where not all of it was level.
  std::optional<Slip> OverLevel(double window_m) const;

  SlipOptions options_;
  TrackKinematics kinematics_;
  std::deque<Sample> samples_;  // the last of the longest window
  double level_since_m_ = 0;    // of sum.path_m: level ground from here on
};

}  // namespace arfm_vo
