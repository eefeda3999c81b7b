#pragma once

#include <optional>
#include <string>
#include <utility>

#include "arfm_vo/hardware/guard/guard_message.h"

namespace arfm_vo {

/// The bus as chassis_guard passes it on. The guard may come later, end, and come again. Where it
/// has ended or been silent for 0.15 s the bus is down (kNoGuard), and what is sent by who has
/// moved the rover goes to the bus by itself, as a motion of zero, or as the standby that it is. A
/// guard that wakes up refuses the commands that it finds, for they are old: both send zero then.
class GuardedBus : public CanBus {
 public:
  /// `bus` is the address that the guard was given.
  explicit GuardedBus(std::string bus) : bus_(std::move(bus)) {}

  CanSendStatus Send(const CanFrame& frame) override;
  std::optional<CanFrame> Receive() override;
  CanBusState State() const override;
  std::optional<GuardStop> StandingStop() const override;
  void ReleaseGuard() override { num_released_ = status_.num_stops; }

 private:
  std::string bus_;
  FileDescriptor socket_;
  GuardMessage status_;
  double tried_s_ = -1e9;
  bool has_moved_ = false;
  uint32_t number_ = 0, num_released_ = 0;
};

}  // namespace arfm_vo
