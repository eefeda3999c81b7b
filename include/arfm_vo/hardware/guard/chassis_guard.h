#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "arfm_vo/driving/motion_watch.h"
#include "arfm_vo/hardware/chassis_protocol.h"
#include "arfm_vo/hardware/guard/guard_message.h"

namespace arfm_vo {

/// Stands between chassis_node and the bus, and is the only one to write to it. Passes on commands
/// of the protocol that are fresh and numbered rightly, with no speed above the limits. Sends zero,
/// every 20 ms, where another driver has commanded the chassis within 1 s, and from a stop until it
/// is released; a last motion command older than 100 ms is one; brakes (0x131) where the
/// rover moves otherwise than commanded. Sends nothing before the first motion command or stop, and
/// nothing after chassis_node's farewell (standby). `now_s` is CLOCK_MONOTONIC; has no clock of its
/// own.
class ChassisGuard {
 public:
  /// `say` is told each time that what lets nothing move changes.
  ChassisGuard(std::unique_ptr<CanBus> bus, std::function<void(GuardStop)> say);
  /// Leaves the rover standing, in standby.
  ~ChassisGuard();

  /// The connection of chassis_node has ended, or a new one begins.
  void Disconnect();
  void Take(double now_s, const GuardMessage& message);
  /// Stands until chassis_node releases as many stops as there were.
  void Stop(GuardStop reason);

  /// To be called every 20 ms or more often, and after all above. What chassis_node is to be told:
  /// the frames that came from the bus, oldest first, and how the guard stands.
  std::vector<GuardMessage> Tick(double now_s);

 private:
  void TakeFrame(double now_s, const CanFrame& frame);
  void Send(const CanFrame& frame) { last_send_ = bus_->Send(frame); }
  void SendMotion(double now_s);
  void Watch(double now_s);
  GuardStop FindStop(double now_s) const;

  static constexpr double kLongAgo_s = -1e9;
  std::unique_ptr<CanBus> bus_;
  std::function<void(GuardStop)> say_;
  MotionWatch watch_;
  ControlMode mode_ = ControlMode::kUnknown;
  CanSendStatus last_send_ = CanSendStatus::kSent;
  bool has_spoken_ = false, is_brake_on_ = false;
  PlanarMotion wanted_, sent_;  // of chassis_node, to the bus
  double commanded_s_ = kLongAgo_s, sent_s_ = kLongAgo_s, foreign_s_ = kLongAgo_s;
  double braked_s_ = kLongAgo_s, told_s_ = kLongAgo_s;
  uint32_t number_ = 0, num_stops_ = 0;
  GuardStop stop_ = GuardStop::kNone, said_ = GuardStop::kNone;
};

}  // namespace arfm_vo
