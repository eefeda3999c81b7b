#pragma once

#include <deque>
#include <optional>

#include "arfm_vo/driving/track_history.h"
#include "arfm_vo/driving/track_kinematics.h"
#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

struct SlipOptions {
  double window_m = 0.3;        ///< mean way of the tracks over which they are compared with sight
  double max_slip_ratio = 0.5;  ///< of the way ahead; above it the rover stops
  double max_turn_slip_ratio = 0.7;  ///< the same of the turn
  double max_leap_m = 0.5;           ///< a leap of the visual pose beyond this begins a new window

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("window_m", window_m);
    visit("max_slip_ratio", max_slip_ratio);
    visit("max_turn_slip_ratio", max_turn_slip_ratio);
    visit("max_leap_m", max_leap_m);
  }
};

/// Slip over the last window: (track - sight) / max(|track|, |sight|), 0 where they agree, 1 where
/// the tracks run and the rover stays, negative where it slides. A ratio is there only where the
/// tracks drove, or turned, enough in the window to judge.
struct Slip {
  std::optional<double> forward_ratio;
  std::optional<double> turn_ratio;
  double sight_forward_m = 0, track_forward_m = 0;
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

  bool IsExcessive() const;

  /// Forgets the window, as after a stop.
  void Reset() { samples_.clear(); }

 private:
  struct Sample {
    Rigid3 odom_from_base;
    TrackWays ways;
    double track_path_m = 0;  // sums since the last reset
    double sight_forward_m = 0, sight_turn_rad = 0;
  };

  SlipOptions options_;
  TrackKinematics kinematics_;
  std::deque<Sample> samples_;
};

}  // namespace arfm_vo
