#include "arfm_vo/hardware/guard/chassis_guard.h"

#include <utility>

#include "arfm_vo/driving/track_kinematics.h"
#include "arfm_vo/hardware/chassis_link.h"

namespace arfm_vo {
namespace {

constexpr double kPeriod_s = 0.019;  // of ticks of 20 ms each one
constexpr double kMaxCommandAge_s = 0.1, kForeign_s = 1, kBrakeRepeat_s = 0.2;
constexpr int kMaxFramesATick = 500;

/// The pilot, who compares the same, has less, to stop first.
constexpr double kMaxExcess_s = 0.3;

}  // namespace

ChassisGuard::ChassisGuard(std::unique_ptr<CanBus> bus, std::function<void(GuardStop)> say)
    : bus_(std::move(bus)),
      say_(std::move(say)),
      watch_({kMaxExcess_s}, TrackKinematicsOptions{}.gauge_m) {}

ChassisGuard::~ChassisGuard() {
  if (!has_spoken_) return;
  Send(EncodeFrame(MotionCommand{}));
  Send(EncodeFrame(ControlModeCommand{}));
}

void ChassisGuard::Disconnect() {
  number_ = 0;
  commanded_s_ = kLongAgo_s;
}

void ChassisGuard::Take(double now_s, const GuardMessage& message) {
  const double age_s = now_s - message.sent_s;
  if (message.number <= number_ || !(age_s >= 0 && age_s <= kMaxCommandAge_s)) return;
  number_ = message.number;
  if (stop_ != GuardStop::kNone && message.num_stops == num_stops_) {
    stop_ = GuardStop::kNone;
    watch_.Reset();
  }
  const ChassisCommand command = DecodeCommand(message.frame);
  if (const auto* motion = std::get_if<MotionCommand>(&command)) {
    wanted_ = LimitMotion(motion->motion);
    commanded_s_ = message.sent_s;
    has_spoken_ = true;
    SendMotion(now_s);
  } else if (command.index() != 0) {
    Send(message.frame);
    const auto* mode = std::get_if<ControlModeCommand>(&command);
    if (!mode || mode->mode != ControlMode::kStandby) return;
    has_spoken_ = false;
    if (stop_ == GuardStop::kSilence) stop_ = GuardStop::kNone;
  }
}

void ChassisGuard::Stop(GuardStop reason) {
  if (stop_ != GuardStop::kMotion) stop_ = reason;  // the brake stays
  ++num_stops_;
  sent_s_ = kLongAgo_s;
}

GuardStop ChassisGuard::FindStop(double now_s) const {
  if (stop_ != GuardStop::kNone || !has_spoken_) return stop_;
  return now_s - foreign_s_ <= kForeign_s ? GuardStop::kForeign : GuardStop::kNone;
}

void ChassisGuard::SendMotion(double now_s) {
  sent_ = FindStop(now_s) == GuardStop::kNone ? wanted_ : PlanarMotion{};
  sent_s_ = now_s;
  Send(EncodeFrame(MotionCommand{sent_}));
}

void ChassisGuard::TakeFrame(double now_s, const CanFrame& frame) {
  if (IsCommand(frame)) {
    foreign_s_ = now_s;
    sent_s_ = kLongAgo_s;  // ours is to be the last
  }
  const ChassisFeedback feedback = DecodeFeedback(frame);
  if (const auto* state = std::get_if<SystemState>(&feedback)) mode_ = state->mode;
  if (const auto* motion = std::get_if<MotionState>(&feedback))
    watch_.ObserveMotion(now_s, motion->motion);
}

void ChassisGuard::Watch(double now_s) {
  // The remote control may drive; in standby the chassis does not hear the brake.
  if (mode_ != ControlMode::kCan || !has_spoken_) return watch_.Reset();
  watch_.ObserveRest(now_s, sent_.IsZero());
  watch_.ObserveCommand(now_s, sent_);
  const auto fault = watch_.FindFault(now_s);  // a jam is not judged: the ways are not observed
  const bool is_runaway = fault && fault->reason == StopReason::kRunaway;
  if (stop_ != GuardStop::kMotion && (is_runaway || watch_.FindMotionAtRest(now_s)))
    Stop(GuardStop::kMotion);
}

std::vector<GuardMessage> ChassisGuard::Tick(double now_s) {
  std::vector<GuardMessage> told;
  GuardMessage message;
  message.sent_s = now_s;
  for (int i = 0; i < kMaxFramesATick; ++i) {
    const auto frame = bus_->Receive();
    if (!frame) break;
    TakeFrame(now_s, *frame);
    message.frame = *frame;
    told.push_back(message);
  }
  Watch(now_s);
  const bool is_silent = has_spoken_ && now_s - commanded_s_ > kMaxCommandAge_s;
  if (is_silent && stop_ == GuardStop::kNone) Stop(GuardStop::kSilence);
  const GuardStop stop = FindStop(now_s);
  if (stop != GuardStop::kNone && now_s - sent_s_ >= kPeriod_s) SendMotion(now_s);
  const bool brakes = stop_ == GuardStop::kMotion;
  if (brakes != is_brake_on_ || (brakes && now_s - braked_s_ >= kBrakeRepeat_s)) {
    Send(MakeCanFrame(kBrakeCommandId, {static_cast<uint8_t>(brakes)}));
    if (last_send_ == CanSendStatus::kSent) is_brake_on_ = brakes;
    braked_s_ = now_s;
  }
  if (stop != said_) say_(stop);
  said_ = stop;
  if (now_s - told_s_ < kPeriod_s) return told;
  told_s_ = now_s;
  told.push_back({message.version, 0, now_s, num_stops_, 0, {}, bus_->State(), last_send_, stop_});
  return told;
}

}  // namespace arfm_vo
