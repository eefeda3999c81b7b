#pragma once

#include <memory>
#include <string>

#include "arfm_vo/driving/pilot.h"
#include "arfm_vo/hardware/chassis_link.h"

namespace arfm_vo {

/// The pilot at the controls of the chassis. Tick is to be called every 20 ms, and once more right
/// after whatever must not wait; `now_s` is a time that never jumps.
class ChassisDriver {
 public:
  static constexpr char kGuard[] = "chassis_guard";  ///< source of its emergency stops

  ChassisDriver(const PilotOptions& options, std::unique_ptr<CanBus> bus);
  /// Leaves the rover standing, in standby.
  ~ChassisDriver();
  ChassisDriver(const ChassisDriver&) = delete;
  ChassisDriver& operator=(const ChassisDriver&) = delete;

  /// Takes in what the chassis said, lets the pilot decide, and sends the command.
  void Tick(double now_s);
  /// The operator starts the rover anew: what chassis_guard has stopped may move again.
  void ReleaseGuard() {
    link_.ReleaseGuard();
    pilot_.SetEmergencyStop(kGuard, false);
  }

  Pilot& pilot() { return pilot_; }
  const Pilot& pilot() const { return pilot_; }
  ChassisLink& link() { return link_; }
  const ChassisLink& link() const { return link_; }

 private:
  void Take(double now_s, const ChassisFeedback& feedback);
  void ObserveGuard(double now_s);

  Pilot pilot_;
  ChassisLink link_;
  long num_foreign_commands_ = 0;
};

/// What `state` means for who may drive. A lost remote control is no fault here, but told apart.
ChassisStatus ToChassisStatus(const SystemState& state);
/// The faults that SystemState::error_bits name, by both readings, or
/// MotorDriverState::status_bits, such as "battery fault or motor driver, motor 2 silent"; empty
/// where there are none.
std::string DescribeErrors(uint16_t error_bits);
std::string DescribeMotorDriver(const MotorDriverState& state);

}  // namespace arfm_vo
