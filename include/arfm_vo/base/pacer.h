#pragma once

#include <chrono>
#include <thread>

namespace arfm_vo {

/// Keeps a thread in the background to a share of the time: it works in slices of half a
/// millisecond and sleeps in between, so that others, on whatever kernel and with whatever
/// priority, wait no longer than that for its CPU.
class Pacer {
 public:
  /// `share` in (0, 1]; 1: never sleeps.
  explicit Pacer(double share) : rest_per_work_(1 / share - 1), resumed_(Clock::now()) {}

  /// To be called every few microseconds of work.
  void Pause() {
    if (rest_per_work_ <= 0) return;
    const auto worked = Clock::now() - resumed_;
    if (worked < std::chrono::microseconds(500)) return;
    std::this_thread::sleep_for(worked * rest_per_work_);
    resumed_ = Clock::now();
  }

 private:
  using Clock = std::chrono::steady_clock;
  double rest_per_work_;
  Clock::time_point resumed_;
};

}  // namespace arfm_vo
