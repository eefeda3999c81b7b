#pragma once

#include <ros/time.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "arfm_vo/hardware/can_bus.h"
#include "arfm_vo/hardware/chassis_protocol.h"

namespace arfm_vo {

/// Notes the commands that pass on their way to the simulated chassis.
class TappedBus : public CanBus {
 public:
  struct Log {
    int num_commands = 0;
    PlanarMotion last;
    double stopped_s = 0, fastest_mps = 0;
    ControlMode last_mode = ControlMode::kUnknown;
  };

  TappedBus(std::unique_ptr<CanBus> bus, Log* log) : bus_(std::move(bus)), log_(log) {}
  CanSendStatus Send(const CanFrame& frame) override { return bus_->Send(frame); }
  CanBusState State() const override { return bus_->State(); }
  std::optional<CanFrame> Receive() override {
    const auto frame = bus_->Receive();
    if (frame) Note(DecodeCommand(*frame));
    return frame;
  }

 private:
  void Note(const ChassisCommand& command) {
    log_->num_commands += command.index() != 0;
    if (const auto* mode = std::get_if<ControlModeCommand>(&command)) log_->last_mode = mode->mode;
    const auto* motion = std::get_if<MotionCommand>(&command);
    if (!motion) return;
    if (motion->motion.IsZero() && !log_->last.IsZero())
      log_->stopped_s = ros::SteadyTime::now().toSec();
    log_->last = motion->motion;
    log_->fastest_mps = std::max(log_->fastest_mps, std::abs(motion->motion.forward_mps));
  }

  std::unique_ptr<CanBus> bus_;
  Log* log_;
};

}  // namespace arfm_vo
