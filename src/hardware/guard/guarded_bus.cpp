#include "arfm_vo/hardware/guard/guarded_bus.h"

#include <system_error>

#include "arfm_vo/hardware/bus_lock.h"
#include "arfm_vo/hardware/chassis_protocol.h"
#include "arfm_vo/hardware/clock_offset.h"

namespace arfm_vo {
namespace {

constexpr double kMaxSilence_s = 0.15, kRetry_s = 0.2;

}  // namespace

CanBusState GuardedBus::State() const {
  const bool is_heard = socket_.IsOpen() && MonotonicNow() - status_.sent_s <= kMaxSilence_s;
  return is_heard ? status_.bus : CanBusState::kNoGuard;
}

std::optional<CanFrame> GuardedBus::Receive() {
  if (!socket_.IsOpen() && MonotonicNow() - tried_s_ >= kRetry_s) {
    tried_s_ = MonotonicNow();
    socket_ = ConnectToLockHolder(bus_);
    status_ = {};
    number_ = num_released_ = 0;
  }
  while (const auto message = ReceiveMessage(socket_)) {
    if (message->has_frame) return message->frame;
    status_ = *message;
  }
  return std::nullopt;
}

std::optional<GuardStop> GuardedBus::StandingStop() const {
  return status_.num_stops != num_released_ ? status_.stop : GuardStop::kNone;
}

CanSendStatus GuardedBus::Send(const CanFrame& frame) {
  if (State() == CanBusState::kNoGuard) {
    const CanFrame standby = EncodeFrame(ControlModeCommand{});
    try {
      if (has_moved_)
        OpenCanBus(bus_, {}, true)->Send(frame == standby ? frame : EncodeFrame(MotionCommand{}));
    } catch (const std::system_error&) {  // the bus is gone too
    }
    return CanSendStatus::kDown;
  }
  has_moved_ |= std::holds_alternative<MotionCommand>(DecodeCommand(frame));
  GuardMessage message;
  message.number = ++number_;
  message.sent_s = MonotonicNow();
  message.num_stops = num_released_;
  message.frame = frame;
  return SendMessage(socket_, message) ? status_.last_send : CanSendStatus::kBusy;
}

}  // namespace arfm_vo
