#include "arfm_vo/hardware/chassis_link.h"

#include <algorithm>

namespace arfm_vo {
namespace {

constexpr int kMaxFramesACall = 500;
constexpr int kMaxBusyInARow = 4;  // 80 ms of a full queue
constexpr double kModeRetry_s = 0.2;
constexpr int kFarewellAttempts = 5;
constexpr double kLampRepeat_s = 0.5;
/// The turn in place at which the tracks, 0.583 m apart, run at the speed limit, rounded up.
constexpr double kMaxChassisTurnRate_radps = 0.35;

}  // namespace

bool IsCommand(const CanFrame& frame) {
  return frame.kind == CanFrameKind::kData &&
         std::count(kCommandIds.begin(), kCommandIds.end(), frame.id) > 0;
}

PlanarMotion LimitMotion(const PlanarMotion& motion) {
  return {std::clamp(motion.forward_mps, -kMaxSpeed_mps, kMaxSpeed_mps),
          std::clamp(motion.turn_radps, -kMaxChassisTurnRate_radps, kMaxChassisTurnRate_radps)};
}

CanFilters ChassisLink::Filters() {
  CanFilters filters = {{0x200, 0x600}};
  for (const uint32_t id : kCommandIds) filters.push_back({id, 0x7FF});
  return filters;
}

ChassisLink::ChassisLink(std::unique_ptr<CanBus> bus) : bus_(std::move(bus)) {}

void ChassisLink::Keep(const ChassisFeedback& feedback) {
  if (const auto* system = std::get_if<SystemState>(&feedback)) readings_.system = *system;
  if (const auto* motion = std::get_if<MotionState>(&feedback)) readings_.motion = *motion;
  if (const auto* odometer = std::get_if<TrackOdometer>(&feedback)) readings_.odometer = *odometer;
  if (const auto* battery = std::get_if<BatteryState>(&feedback)) readings_.battery = *battery;
  if (const auto* motor = std::get_if<MotorState>(&feedback))
    readings_.motors[static_cast<size_t>(motor->side)] = *motor;
  if (const auto* driver = std::get_if<MotorDriverState>(&feedback))
    readings_.drivers[static_cast<size_t>(driver->side)] = *driver;
}

std::vector<ChassisFeedback> ChassisLink::Receive() {
  std::vector<ChassisFeedback> all;
  for (int i = 0; i < kMaxFramesACall; ++i) {
    const std::optional<CanFrame> frame = bus_->Receive();
    if (!frame) break;
    traffic_.num_bus_off += frame->kind == CanFrameKind::kBusOff;
    if (frame->kind == CanFrameKind::kBusOff) was_bus_lost_ = true;
    if (frame->kind != CanFrameKind::kData && frame->kind != CanFrameKind::kOther) {
      ++traffic_.num_error_frames;
      continue;
    }
    if (IsCommand(*frame)) {
      ++traffic_.num_foreign_commands;
      traffic_.foreign_command_id = frame->id;
      continue;
    }
    const ChassisFeedback feedback = DecodeFeedback(*frame);
    const bool is_readable = feedback.index() != 0;
    ++(is_readable ? traffic_.num_received : traffic_.num_unreadable);
    if (!is_readable) continue;
    Keep(feedback);
    all.push_back(feedback);
  }
  return all;
}

CanSendStatus ChassisLink::SendFrame(const CanFrame& frame) {
  has_spoken_ = true;
  last_send_ = bus_->Send(frame);
  traffic_.num_sent += last_send_ == CanSendStatus::kSent;
  traffic_.num_send_busy += last_send_ == CanSendStatus::kBusy;
  traffic_.num_send_down += last_send_ == CanSendStatus::kDown;
  num_busy_in_a_row_ = last_send_ == CanSendStatus::kBusy ? num_busy_in_a_row_ + 1 : 0;
  return last_send_;
}

void ChassisLink::RequestCanMode(double now_s) {
  if (!readings_.system) return;
  const ControlMode mode = readings_.system->mode;
  const bool is_due =
      !mode_requested_s_ || now_s - *mode_requested_s_ >= kModeRetry_s || mode != mode_at_request_;
  mode_at_request_ = mode;
  if (mode == ControlMode::kCan || mode == ControlMode::kRemote || !is_due) return;
  mode_requested_s_ = now_s;
  SendFrame(EncodeFrame(ControlModeCommand{ControlMode::kCan}));
}

void ChassisLink::SendLamp(double now_s, bool is_on) {
  const bool is_due = is_on && now_s - lamp_sent_s_ >= kLampRepeat_s;
  if (is_on == is_lamp_on_ && !is_due) return;
  is_lamp_on_ = is_on;
  lamp_sent_s_ = now_s;
  SendFrame(EncodeFrame(LightCommand{is_on, num_lamp_frames_++}));
}

void ChassisLink::Send(double now_s, const DriveCommand& command) {
  was_bus_lost_ = false;
  if (!command.may_speak) return;
  if (command.wants_authority) RequestCanMode(now_s);
  SendFrame(EncodeFrame(MotionCommand{LimitMotion(command.chassis_motion)}));
  SendLamp(now_s, command.is_lamp_on);
}

void ChassisLink::SendFarewell() {
  if (!has_spoken_) return;
  std::vector<CanFrame> frames = {EncodeFrame(MotionCommand{}), EncodeFrame(ControlModeCommand{})};
  if (is_lamp_on_) frames.push_back(EncodeFrame(LightCommand{false, num_lamp_frames_}));
  for (const CanFrame& frame : frames) {
    for (int i = 0; i < kFarewellAttempts && SendFrame(frame) == CanSendStatus::kBusy; ++i) {
    }
  }
}

bool ChassisLink::IsBusUp() const {
  return bus_->State() == CanBusState::kUp && !was_bus_lost_ &&
         last_send_ != CanSendStatus::kDown && num_busy_in_a_row_ < kMaxBusyInARow;
}

}  // namespace arfm_vo
