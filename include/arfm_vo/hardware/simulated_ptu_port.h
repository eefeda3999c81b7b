#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "arfm_vo/hardware/clock_offset.h"
#include "arfm_vo/hardware/file_descriptor.h"
#include "arfm_vo/hardware/simulated_ptu.h"

namespace arfm_vo {

/// A serial line without hardware: what is written here is read from a device file, and the other
/// way round. Closing it is unplugging the device.
class PseudoTerminal {
 public:
  /// `link` is the name of a symbolic link to the device file, made in place of one to a pseudo
  /// terminal that is gone, as an earlier simulation leaves behind. Throws std::system_error, also
  /// where anything else has that name.
  explicit PseudoTerminal(const std::string& link);
  ~PseudoTerminal();
  PseudoTerminal(const PseudoTerminal&) = delete;

  /// The bytes that the other end wrote; waits for the first. Empty on timeout.
  std::string Read(double timeout_s);
  void Write(const std::string& bytes);

 private:
  std::string link_, device_;
  FileDescriptor master_;
  FileDescriptor keeper_;  ///< keeps the line up while no program has it open
};

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
