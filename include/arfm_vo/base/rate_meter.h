#pragma once

#include <cstddef>
#include <deque>

namespace arfm_vo {

/// The rate of events over the last seconds.
class RateMeter {
 public:
  explicit RateMeter(double window_s = 5) : window_s_(window_s) {}

  void Add(double now_s) {
    times_.push_back(now_s);
    Forget(now_s);
  }
  /// Events per second; 0 where there were fewer than two.
  double Rate(double now_s) {
    Forget(now_s);
    if (times_.size() < 2) return 0;
    return static_cast<double>(times_.size() - 1) / (times_.back() - times_.front());
  }
  void Clear() { times_.clear(); }

 private:
  void Forget(double now_s) {
    while (!times_.empty() && times_.front() < now_s - window_s_) times_.pop_front();
  }

  double window_s_;
  std::deque<double> times_;
};

}  // namespace arfm_vo
