#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "arfm_vo/odometry/session.h"
#include "arfm_vo/ros/node/console_watch.h"

namespace arfm_vo {

/// A line for the console.
struct ConsoleLine {
  bool is_warning = false;
  std::string text;
};

/// What pose_node tells on the console: the first pose, why there is none and what to do about it,
/// that it is back, and the totals.
class OdometryConsole {
 public:
  /// Takes the next pair; `now_s` is any steady time. Nothing where there is nothing to tell.
  std::optional<ConsoleLine> Take(const StereoFrame& frame, const SessionUpdate& pose,
                                  double now_s);

  /// All pairs so far in a line.
  std::string Totals(uint32_t num_dropped, uint32_t num_refused) const;

 private:
  ConsoleLine TellTracked(double now_s) const;

  ConsoleWatch watch_;
  bool is_lost_told_ = false;
  std::optional<double> last_tracked_s_;
  uint32_t num_pairs_ = 0, num_tracked_ = 0, num_lost_ = 0, num_degraded_ = 0;
};

}  // namespace arfm_vo
