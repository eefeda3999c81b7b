#include "arfm_vo/hardware/chassis_driver.h"

#include <utility>

namespace arfm_vo {

ChassisStatus ToChassisStatus(const SystemState& state) {
  ChassisStatus status;
  status.is_emergency_stop = state.vehicle == VehicleState::kEmergencyStop;
  status.has_fault =
      state.vehicle == VehicleState::kFault || (state.error_bits & kUnderVoltageFault) != 0;
  status.authority = state.mode == ControlMode::kCan       ? ChassisAuthority::kUs
                     : state.mode == ControlMode::kRemote  ? ChassisAuthority::kRemoteControl
                     : state.mode == ControlMode::kStandby ? ChassisAuthority::kNobody
                                                           : ChassisAuthority::kOther;
  return status;
}

ChassisDriver::ChassisDriver(const PilotOptions& options, std::unique_ptr<CanBus> bus)
    : pilot_(options), link_(std::move(bus)) {}

ChassisDriver::~ChassisDriver() { link_.SendFarewell(); }

void ChassisDriver::Tick(double now_s) {
  for (const ChassisFeedback& feedback : link_.Receive()) {
    if (const auto* state = std::get_if<SystemState>(&feedback))
      pilot_.ObserveChassis(now_s, ToChassisStatus(*state));
    if (const auto* odometer = std::get_if<TrackOdometer>(&feedback))
      pilot_.ObserveTracks(now_s, odometer->left_mm, odometer->right_mm);
  }
  pilot_.ObserveBus(link_.IsBusUp());
  link_.Send(now_s, pilot_.Tick(now_s));
}

}  // namespace arfm_vo
