#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "arfm_vo/hardware/monotonic_clock.h"
#include "arfm_vo/hardware/pseudo_terminal.h"
#include "arfm_vo/hardware/simulated_ptu.h"

namespace arfm_vo {

/// A simulated PTU behind a device file, on a thread of its own. For several threads.
class SimulatedPtuPort {
 public:
  using Clock = std::function<double()>;  ///< s, must not go back; called on the port's thread too

  /// `link` is the name of the device file to make. Where the clock may stand still, the unit is
  /// mute meanwhile unless its line and replies take no time (SimulatedPtuOptions::Instant).
  /// Throws std::system_error.
  explicit SimulatedPtuPort(const std::string& link, const SimulatedPtuOptions& options = {},
                            Clock clock = &MonotonicNow);
  ~SimulatedPtuPort();

  /// Pulls the plug: the device file is gone, the unit keeps its power.
  void Unplug();
  void Plug();

  /// The true position now, counts.
  double Position(PtuAxis axis);
  /// The same in rad.
  double Angle(PtuAxis axis);
  void HitLimit(PtuAxis axis, double slip_counts);

 private:
  void Run();

  const std::string link_;
  const double pan_count_rad_, tilt_count_rad_;
  const Clock clock_;
  std::mutex mutex_;  ///< guards what follows
  SimulatedPtu ptu_;
  std::unique_ptr<PseudoTerminal> line_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace arfm_vo
