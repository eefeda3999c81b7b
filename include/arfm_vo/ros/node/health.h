#pragma once

#include <diagnostic_updater/DiagnosticStatusWrapper.h>
#include <ros/time.h>

#include <functional>
#include <limits>
#include <string>
#include <utility>

#include "arfm_vo/base/median.h"
#include "arfm_vo/base/rate_meter.h"

namespace arfm_vo {

/// One line of a node's /diagnostics, and its values.
using Diagnostics = diagnostic_updater::DiagnosticStatusWrapper;

/// How often the pairs of a node come, and how long it works on each.
class PairTimes {
 public:
  void Add(double ms);
  /// Adds the pairs a second, over the last 5 s, and the time of the last one.
  void Report(Diagnostics& status);
  /// The end of a node's totals: its time for a pair, of the last 1000.
  std::string Total() const;

 private:
  RateMeter rate_;
  RunningMedian ms_{1000};
  double last_ms_ = 0;
};

/// What a node could not work on: counted, told on the console, at most every 5 s, and in the
/// diagnostics until the next item is worked on.
class Refusals {
 public:
  /// `item` is what the node works on, such as "pair".
  explicit Refusals(std::string item) : item_(std::move(item)) {}
  void Add(const std::string& why);
  void Clear() { newest_.clear(); }
  /// Where the newest item was refused, true and an ERROR in `status`.
  bool IsTold(Diagnostics& status) const;
  uint32_t num() const { return num_; }

 private:
  static constexpr double kRepeat_s = 5;
  std::string item_, newest_;
  double told_s_ = -kRepeat_s;  ///< when it was last told on the console
  uint32_t num_ = 0;
};

/// Decides when a problem that is looked for again and again is told on the console: when it has
/// lasted for `kPatience_s`, and then every `kRepeat_s` for as long as it lasts.
class ConsoleWatch {
 public:
  static constexpr double kPatience_s = 2, kRepeat_s = 10;

  /// Whether to tell `problem` now; empty: there is none. `now_s` is any steady time.
  bool IsDue(const std::string& problem, double now_s = ros::SteadyTime::now().toSec());

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double since_s_ = kInfinity;  ///< infinity: no problem
  double told_s_ = -kInfinity;
};

/// ROS_INFO also while the node ends, when rosconsole prints nothing any more.
void TellAtEnd(const std::string& text);
/// Tells what `save` returns, or that `what` is not saved and why.
void TellSavedAtEnd(const std::string& what, const std::function<std::string()>& save);

}  // namespace arfm_vo
