#pragma once

#include <chrono>

namespace arfm_vo {

/// Wall time since construction or the last Lap.
class Stopwatch {
 public:
  /// Time in ms since the last call; starts anew.
  double LapMs() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double, std::milli> lap = now - start_;
    start_ = now;
    return lap.count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace arfm_vo
