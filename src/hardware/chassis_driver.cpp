#include "arfm_vo/hardware/chassis_driver.h"

#include <cmath>
#include <utility>

namespace arfm_vo {

ChassisStatus ToChassisStatus(const SystemState& state) {
  ChassisStatus status;
  status.is_emergency_stop = state.vehicle == VehicleState::kEmergencyStop;
  status.has_fault =
      state.vehicle == VehicleState::kFault || (state.error_bits & kUnderVoltageFault) != 0;
  status.is_remote_lost = (state.error_bits & kRemoteLost) != 0;
  status.authority = state.mode == ControlMode::kCan       ? ChassisAuthority::kUs
                     : state.mode == ControlMode::kRemote  ? ChassisAuthority::kRemoteControl
                     : state.mode == ControlMode::kStandby ? ChassisAuthority::kNobody
                                                           : ChassisAuthority::kOther;
  return status;
}

ChassisDriver::ChassisDriver(const PilotOptions& options, std::unique_ptr<CanBus> bus)
    : pilot_(options), link_(std::move(bus)) {}

ChassisDriver::~ChassisDriver() { link_.SendFarewell(); }

void ChassisDriver::Take(double now_s, const ChassisFeedback& feedback) {
  MotionWatch& watch = pilot_.motion_watch();
  if (const auto* state = std::get_if<SystemState>(&feedback)) {
    ChassisStatus status = ToChassisStatus(*state);
    for (const auto& driver : link_.Readings().drivers)
      status.has_motor_fault |= driver && (driver->status_bits & kMotorFaultBits) != 0;
    pilot_.ObserveChassis(now_s, status);
    watch.ObserveCounter(now_s, state->count);
  } else if (const auto* odometer = std::get_if<TrackOdometer>(&feedback)) {
    pilot_.ObserveTracks(now_s, odometer->left_mm, odometer->right_mm);
  } else if (const auto* motion = std::get_if<MotionState>(&feedback)) {
    watch.ObserveMotion(now_s, motion->motion);
  } else if (std::holds_alternative<MotorState>(feedback)) {
    double current_a = 0;
    for (const auto& motor : link_.Readings().motors)
      if (motor) current_a = std::max(current_a, std::abs(motor->current_a));
    watch.ObserveCurrent(now_s, current_a);
  }
}

void ChassisDriver::Tick(double now_s) {
  for (const ChassisFeedback& feedback : link_.Receive()) Take(now_s, feedback);
  const long num_foreign = link_.Traffic().num_foreign_commands;
  if (num_foreign != num_foreign_commands_) pilot_.ObserveForeignCommand(now_s);
  num_foreign_commands_ = num_foreign;
  pilot_.ObserveBus(link_.IsBusUp());
  link_.Send(now_s, pilot_.Tick(now_s));
}

}  // namespace arfm_vo
