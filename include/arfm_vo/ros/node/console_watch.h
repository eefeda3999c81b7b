#pragma once

#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <string>

namespace arfm_vo {

/// ROS_INFO also while the node ends, when rosconsole prints nothing any more.
inline void TellAtEnd(const std::string& text) {
  if (ros::ok()) {
    ROS_INFO("%s", text.c_str());
  } else {
    std::printf("[ INFO] %s\n", text.c_str());
    std::fflush(stdout);
  }
}

/// Tells what `save` returns, or that `what` is not saved and why.
template <class Save>
void TellSavedAtEnd(const std::string& what, Save&& save) {
  try {
    TellAtEnd(save());
  } catch (const std::exception& error) {
    TellAtEnd("ERROR: " + what + " not saved: " + error.what());
  }
}

/// Decides when a problem that is looked for again and again is told on the console: when it has
/// lasted for `kPatience_s`, and then every `kRepeat_s` for as long as it lasts.
class ConsoleWatch {
 public:
  static constexpr double kPatience_s = 2, kRepeat_s = 10;

  /// Whether to tell `problem` now; empty: there is none. `now_s` is any steady time.
  bool IsDue(const std::string& problem, double now_s) {
    since_s_ = problem.empty() ? kInfinity : std::min(since_s_, now_s);
    if (now_s - since_s_ < kPatience_s || now_s - told_s_ < kRepeat_s) return false;
    told_s_ = now_s;
    return true;
  }

 private:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double since_s_ = kInfinity;  ///< infinity: no problem
  double told_s_ = -kInfinity;
};

}  // namespace arfm_vo
