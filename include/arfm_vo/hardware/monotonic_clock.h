#pragma once

#include <ctime>

namespace arfm_vo {

/// CLOCK_MONOTONIC in seconds, the clock of V4L2's stamps.
inline double MonotonicNow() {
  timespec now{};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace arfm_vo
