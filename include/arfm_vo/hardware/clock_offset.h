#pragma once

#include <ctime>
#include <functional>
#include <limits>

namespace arfm_vo {

/// CLOCK_MONOTONIC in seconds, the clock of V4L2's stamps.
inline double MonotonicNow() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Brings stamps of the monotonic clock to a wall clock. The wall clock is steered and set while
/// the machine runs, so the offset is measured again and again.
class ClockOffset {
 public:
  using Clock = std::function<double()>;  ///< seconds

  /// Measures at the first use and then every `period_s` of the monotonic clock.
  ClockOffset(Clock monotonic, Clock wall, double period_s = 1);

  double ToWall(double monotonic_s);

  /// Times that the wall clock was set (moved by more than 10 ms between measurements).
  int num_jumps() const { return num_jumps_; }
  double offset_s() const { return offset_s_; }

 private:
  double Measure() const;

  const Clock monotonic_, wall_;
  const double period_s_;
  double offset_s_ = 0;
  double measured_s_ = -std::numeric_limits<double>::infinity();
  int num_jumps_ = 0;
};

}  // namespace arfm_vo
