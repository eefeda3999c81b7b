#pragma once

#include <chrono>
#include <deque>

namespace arfm_vo {

/// How often something happens, over the last seconds of wall time.
class WallRate {
 public:
  void Tick() { ticks_.push_back(Clock::now()); }

  /// Per second.
  double Get() {
    const auto start = Clock::now() - std::chrono::seconds(kWindow_s);
    while (!ticks_.empty() && ticks_.front() < start) ticks_.pop_front();
    return static_cast<double>(ticks_.size()) / kWindow_s;
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int kWindow_s = 5;
  std::deque<Clock::time_point> ticks_;
};

}  // namespace arfm_vo
