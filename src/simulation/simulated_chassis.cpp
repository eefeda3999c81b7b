#include "arfm_vo/simulation/simulated_chassis.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arfm_vo/driving/track_kinematics.h"
#include "arfm_vo/hardware/chassis_link.h"

namespace arfm_vo {
namespace {

constexpr double kCommandTimeout_s = 0.5;
constexpr double kFastPeriod_s = 0.02;
constexpr double kSlowPeriod_s = 0.1;
constexpr double kMaxStep_s = 0.01;
constexpr double kSprocketRadius_m = 0.165;
constexpr double kSupply_v = 28.7;
constexpr int kMaxFramesATick = 500;

int ToMillimetres(double way_m) { return static_cast<int>(std::lround(1000 * way_m)); }

MotorState MotorOf(ChassisSide side, double speed_mps, double way_m) {
  MotorState motor;
  motor.side = side;
  motor.speed_rpm = static_cast<int>(std::lround(speed_mps / kSprocketRadius_m * 30 / M_PI));
  motor.current_a = 20 * std::abs(speed_mps);
  motor.pulses = static_cast<int32_t>(std::lround(way_m * 1000));
  return motor;
}

}  // namespace

SimulatedChassis::SimulatedChassis(std::unique_ptr<CanBus> bus, TrackedPlant plant)
    : bus_(std::move(bus)), plant_(std::move(plant)) {}

void SimulatedChassis::SetFault(uint16_t error_bits) {
  has_fault_ = true;
  error_bits_ = error_bits;
}

void SimulatedChassis::TakeRemoteControl(const PlanarMotion& stick) {
  mode_ = ControlMode::kRemote;
  stick_ = stick;
}

void SimulatedChassis::HandBack() { mode_ = ControlMode::kStandby; }

void SimulatedChassis::SetPower(bool is_on) {
  is_on_ = is_on;
  mode_ = ControlMode::kStandby;
}

void SimulatedChassis::Obey(double now_s) {
  for (int i = 0; i < kMaxFramesATick; ++i) {
    const auto frame = bus_->Receive();
    if (!frame) return;
    if (!is_on_) continue;
    if (frame->id == kBrakeCommandId && mode_ == ControlMode::kCan)
      is_brake_on_ = frame->bytes[0] != 0;
    const ChassisCommand command = DecodeCommand(*frame);
    if (const auto* mode = std::get_if<ControlModeCommand>(&command)) {
      const bool is_known = mode->mode == ControlMode::kStandby || mode->mode == ControlMode::kCan;
      if (mode_ != ControlMode::kRemote && is_known) mode_ = mode->mode;
    } else if (const auto* motion = std::get_if<MotionCommand>(&command)) {
      if (mode_ != ControlMode::kCan) continue;
      commanded_ = motion->motion;
      commanded_s_ = now_s;
    } else if (std::holds_alternative<ClearErrorsCommand>(command)) {
      has_fault_ = false;
      error_bits_ = 0;
    } else if (const auto* light = std::get_if<LightCommand>(&command)) {
      is_lamp_on_ = light->is_on;
    }
  }
}

PlanarMotion SimulatedChassis::MotionNow(double now_s) const {
  if (runaway_) return *runaway_;
  if (!is_on_ || is_emergency_stop_ || has_fault_ || is_brake_on_) return {};
  if (mode_ == ControlMode::kRemote) return stick_;
  const bool is_fresh = now_s - commanded_s_ <= kCommandTimeout_s;
  return mode_ == ControlMode::kCan && is_fresh ? commanded_ : PlanarMotion{};
}

void SimulatedChassis::Tick(double now_s) {
  if (!has_ticked_) last_s_ = fast_due_s_ = slow_due_s_ = now_s;
  has_ticked_ = true;
  Obey(now_s);
  const TrackKinematics kinematics(TrackKinematicsOptions{});  // the chassis' own: without slip
  TrackSpeeds commanded = kinematics.TracksFor(MotionNow(now_s));
  if (is_left_jammed_) commanded.left_mps = 0;
  while (last_s_ < now_s) {
    const double dt_s = std::min(kMaxStep_s, now_s - last_s_);
    plant_.Step(commanded, dt_s);
    last_s_ += dt_s;
  }
  last_s_ = now_s;
  if (is_on_) SendFeedback(now_s);
}

void SimulatedChassis::SendFeedback(double now_s) {
  constexpr double kSlack_s = 1e-6;
  if (now_s >= fast_due_s_ - kSlack_s) {
    SendFastFeedback();
    fast_due_s_ = std::max(fast_due_s_ + kFastPeriod_s, now_s);
  }
  if (now_s >= slow_due_s_ - kSlack_s) {
    SendSlowFeedback();
    slow_due_s_ = std::max(slow_due_s_ + kSlowPeriod_s, now_s);
  }
}

void SimulatedChassis::SendFastFeedback() {
  if (!is_frozen_) {
    told_speeds_ = plant_.Speeds();
    told_ways_ = plant_.Ways();
  }
  const TrackSpeeds& speeds = told_speeds_;
  const TrackWays& ways = told_ways_;
  if (silent_ != FeedbackKind::kMotion)
    Send(MotionState{TrackKinematics(TrackKinematicsOptions{}).MotionOf(speeds)});
  Send(MotorOf(ChassisSide::kLeft, speeds.left_mps, ways.left_m));
  Send(MotorOf(ChassisSide::kRight, speeds.right_mps, ways.right_m));
  if (silent_ == FeedbackKind::kOdometer) return;
  Send(TrackOdometer{ToMillimetres(ways.left_m), ToMillimetres(ways.right_m)});
}

void SimulatedChassis::SendSlowFeedback() {
  SystemState state;
  state.vehicle = is_emergency_stop_ ? VehicleState::kEmergencyStop
                  : has_fault_       ? VehicleState::kFault
                                     : VehicleState::kOk;
  state.mode = mode_;
  state.battery_v = kSupply_v;
  state.error_bits = error_bits_ | (is_remote_lost_ ? kRemoteLost : 0);
  state.count = is_frozen_ ? count_ : ++count_;
  Send(state);
  for (const ChassisSide side : {ChassisSide::kLeft, ChassisSide::kRight})
    Send(MotorDriverState{side, kSupply_v, 35, 30, motor_status_bits_});
  Send(BatteryState{88, 99, kSupply_v, 2.5, 21.5});
}

}  // namespace arfm_vo
