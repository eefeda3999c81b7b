#include "arfm_vo/ros/node/health.h"

#include <ros/console.h>
#include <ros/init.h>

#include <algorithm>
#include <cstdio>

#include "arfm_vo/base/format.h"

namespace arfm_vo {

void PairTimes::Add(double ms) {
  rate_.Add(ros::SteadyTime::now().toSec());
  ms_.Add(ms);
  last_ms_ = ms;
}

void PairTimes::Report(Diagnostics& status) {
  status.addf("pairs a second", "%.1f", rate_.Rate(ros::SteadyTime::now().toSec()));
  status.addf("time of the last pair (ms)", "%.1f", last_ms_);
}

std::string PairTimes::Total() const { return Format("; median %.1f ms a pair", ms_.Median()); }

void Refusals::Add(const std::string& why) {
  ++num_;
  newest_ = why;
  const double now_s = ros::SteadyTime::now().toSec();
  if (now_s - told_s_ < kRepeat_s) return;
  told_s_ = now_s;
  ROS_ERROR("%s refused: %s", item_.c_str(), why.c_str());
}

bool Refusals::IsTold(Diagnostics& status) const {
  if (newest_.empty()) return false;
  status.summary(Diagnostics::ERROR, item_ + " refused: " + newest_);
  return true;
}

bool ConsoleWatch::IsDue(const std::string& problem, double now_s) {
  since_s_ = problem.empty() ? kInfinity : std::min(since_s_, now_s);
  if (now_s - since_s_ < kPatience_s || now_s - told_s_ < kRepeat_s) return false;
  told_s_ = now_s;
  return true;
}

void TellAtEnd(const std::string& text) {
  if (ros::ok()) {
    ROS_INFO("%s", text.c_str());
  } else {
    std::printf("[ INFO] %s\n", text.c_str());
    std::fflush(stdout);
  }
}

void TellSavedAtEnd(const std::string& what, const std::function<std::string()>& save) {
  try {
    TellAtEnd(save());
  } catch (const std::exception& error) {
    TellAtEnd("ERROR: " + what + " not saved: " + error.what());
  }
}

}  // namespace arfm_vo
