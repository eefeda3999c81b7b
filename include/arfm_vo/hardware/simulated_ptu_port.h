#pragma once

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "arfm_vo/hardware/pseudo_terminal.h"
#include "arfm_vo/hardware/simulated_ptu.h"

namespace arfm_vo {

/// A simulated PTU behind a device file, in real time, on a thread of its own. For several threads.
class SimulatedPtuPort {
 public:
  /// `link` is the name of the device file to make. Throws std::system_error.
  explicit SimulatedPtuPort(const std::string& link, const SimulatedPtuOptions& options = {});
  ~SimulatedPtuPort();

  /// Pulls the plug: the device file is gone, the unit keeps its power.
  void Unplug();
  void Plug();

  /// The true position now, counts.
  double Position(PtuAxis axis);
  void HitLimit(PtuAxis axis, double slip_counts);

 private:
  void Run();

  const std::string link_;
  std::mutex mutex_;  ///< guards what follows
  SimulatedPtu ptu_;
  std::unique_ptr<PseudoTerminal> line_;
  std::atomic<bool> is_stopping_{false};
  std::thread thread_;
};

}  // namespace arfm_vo
