#include "arfm_vo/hardware/chassis_driver.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "arfm_vo/base/format.h"
#include "arfm_vo/hardware/guard/guard_message.h"

namespace arfm_vo {
namespace {

/// [bit], of SystemState::error_bits.
constexpr std::array<const char*, 10> kErrors = {"battery fault",
                                                 "battery warning",
                                                 "remote control lost",
                                                 "motor 1 silent",
                                                 "motor 2 silent",
                                                 "motor 3 silent",
                                                 "motor 4 silent",
                                                 "steering encoder",
                                                 "battery fault or motor driver",
                                                 "battery warning or high-level communication"};
/// [bit], of MotorDriverState::status_bits.
constexpr std::array<const char*, 6> kMotorFaults = {
    "low input voltage", "motor too hot", "overload", "driver too hot", "sensor", "driver"};

template <size_t kNumNames>
std::string NameBits(uint16_t bits, const std::array<const char*, kNumNames>& names) {
  std::string text;
  for (size_t bit = 0; bit < 16; ++bit) {
    if ((bits >> bit & 1) == 0) continue;
    if (!text.empty()) text += ", ";
    text += bit < kNumNames ? names[bit] : Format("bit %zu", bit);
  }
  return text;
}

}  // namespace

std::string DescribeErrors(uint16_t error_bits) { return NameBits(error_bits, kErrors); }

std::string DescribeMotorDriver(const MotorDriverState& state) {
  const std::string faults = NameBits(state.status_bits & kMotorFaultBits, kMotorFaults);
  if (faults.empty()) return "";
  return (state.side == ChassisSide::kLeft ? "left: " : "right: ") + faults;
}

ChassisStatus ToChassisStatus(const SystemState& state) {
  ChassisStatus status;
  status.is_emergency_stop = state.vehicle == VehicleState::kEmergencyStop;
  status.has_fault =
      state.vehicle == VehicleState::kFault || (state.error_bits & ~kErrorBitsNoFault) != 0;
  status.detail = DescribeErrors(state.error_bits);
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
  ChassisWatch& chassis = pilot_.chassis_watch();
  const auto hear = [&](FeedbackKind left, FeedbackKind right, ChassisSide side) {
    chassis.ObserveFeedback(now_s, side == ChassisSide::kLeft ? left : right);
  };
  if (const auto* state = std::get_if<SystemState>(&feedback)) {
    ChassisStatus status = ToChassisStatus(*state);
    for (const auto& driver : link_.Readings().drivers) {
      if (!driver || (driver->status_bits & kMotorFaultBits) == 0) continue;
      status.has_motor_fault = true;
      status.detail += (status.detail.empty() ? "" : ", ") + DescribeMotorDriver(*driver);
    }
    chassis.Observe(now_s, status);
    watch.ObserveCounter(now_s, state->count);
  } else if (const auto* odometer = std::get_if<TrackOdometer>(&feedback)) {
    pilot_.ObserveTracks(now_s, odometer->left_mm, odometer->right_mm);
  } else if (const auto* motion = std::get_if<MotionState>(&feedback)) {
    watch.ObserveMotion(now_s, motion->motion);
    chassis.ObserveFeedback(now_s, FeedbackKind::kMotion);
  } else if (const auto* driver = std::get_if<MotorDriverState>(&feedback)) {
    hear(FeedbackKind::kLeftDriver, FeedbackKind::kRightDriver, driver->side);
  } else if (const auto* heard = std::get_if<MotorState>(&feedback)) {
    hear(FeedbackKind::kLeftMotor, FeedbackKind::kRightMotor, heard->side);
    double current_a = 0;
    for (const auto& motor : link_.Readings().motors)
      if (motor) current_a = std::max(current_a, std::abs(motor->current_a));
    watch.ObserveCurrent(now_s, current_a);
  }
}

void ChassisDriver::ObserveGuard(double now_s) {
  const auto stop = link_.StandingStop();
  const bool is_halt = stop == GuardStop::kSilence;
  if (stop) pilot_.SetEmergencyStop(kGuard, !is_halt && *stop != GuardStop::kNone);
  if (!is_halt) return;
  pilot_.ObserveHalt(now_s);
  link_.ReleaseGuard();
}

void ChassisDriver::Tick(double now_s) {
  for (const ChassisFeedback& feedback : link_.Receive()) Take(now_s, feedback);
  const ChassisTraffic& traffic = link_.Traffic();
  if (traffic.num_foreign_commands != num_foreign_commands_)
    pilot_.chassis_watch().ObserveForeignCommand(now_s,
                                                 Format("(0x%03X)", traffic.foreign_command_id));
  num_foreign_commands_ = traffic.num_foreign_commands;
  const CanBusState bus = link_.BusState();
  pilot_.chassis_watch().ObserveBus(link_.IsBusUp(),
                                    bus == CanBusState::kUp ? "" : Format("(%s)", ToString(bus)));
  ObserveGuard(now_s);
  link_.Send(now_s, pilot_.Tick(now_s));
}

}  // namespace arfm_vo
