#include "arfm_vo/hardware/pan_tilt.h"

#include <system_error>

#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

constexpr int kMaxFailedReads = 5;  ///< in a row; then the line is opened anew

}  // namespace

void PanTiltOptions::Check() const {
  RequireAbove(home_timeout_s, 0, 600, "home_timeout_s");
  RequireAbove(reply_timeout_s, 0, 10, "reply_timeout_s");
  RequireInRange(pan_speed_rad_s, 0, 100, "pan_speed_rad_s");
  RequireInRange(tilt_speed_rad_s, 0, 100, "tilt_speed_rad_s");
  reopen.Check();
}

const char* ToString(PanTiltState state) {
  constexpr const char* kNames[] = {"closed", "homing", "ready"};
  return kNames[static_cast<size_t>(state)];
}

PanTilt::PanTilt(const PanTiltOptions& options, std::function<std::unique_ptr<ByteStream>()> open,
                 std::function<double()> now)
    : options_((options.Check(), options)),
      open_(std::move(open)),
      now_(std::move(now)),
      backoff_(options.reopen),
      must_home_(options.home_at_start) {}

PanTiltReadings PanTilt::Step() {
  try {
    switch (state_) {
      case PanTiltState::kClosed:
        if (backoff_.IsDue(now_())) Open();
        return {};
      case PanTiltState::kHoming:
        ContinueHoming();
        return {};
      case PanTiltState::kReady:
        return Read();
    }
  } catch (const std::system_error& error) {
    Close(error.what());
  }
  return {};
}

void PanTilt::Open() {
  unit_ = std::make_unique<PanTiltUnit>(open_(), options_.reply_timeout_s);
  if (!unit_->Connect()) return Close("the unit does not answer as a PTU does");
  if (num_opened_++ > 0) ++num_reopened_;
  backoff_.Succeed();
  num_failed_reads_ = 0;
  state_ = PanTiltState::kReady;
  problem_.clear();
  SetSpeeds();
  if (must_home_) StartHoming();
}

void PanTilt::SetSpeeds() {
  for (const auto& [axis, speed] : {std::pair(PtuAxis::kPan, options_.pan_speed_rad_s),
                                    {PtuAxis::kTilt, options_.tilt_speed_rad_s}})
    if (speed > 0)
      if (const auto refusal = unit_->SetSpeed(axis, speed)) problem_ = *refusal;
}

void PanTilt::Close(const std::string& problem) {
  unit_.reset();
  is_homed_ = false;
  state_ = PanTiltState::kClosed;
  problem_ = problem;
  backoff_.Fail(now_());
}

void PanTilt::StartHoming() {
  unit_->StartHoming();
  homing_deadline_s_ = now_() + options_.home_timeout_s;
  state_ = PanTiltState::kHoming;
}

void PanTilt::ContinueHoming() {
  if (unit_->PollHoming()) {
    must_home_ = has_lost_position_ = false;
    is_homed_ = true;
    state_ = PanTiltState::kReady;
  } else if (now_() > homing_deadline_s_) {
    Close("homing did not end in time");
  }
}

PanTiltReadings PanTilt::Read() {
  const PanTiltReadings readings{unit_->ReadPosition(PtuAxis::kPan),
                                 unit_->ReadPosition(PtuAxis::kTilt)};
  has_lost_position_ = unit_->HasLostPosition() || has_lost_position_;
  num_failed_reads_ = readings.pan && readings.tilt ? 0 : num_failed_reads_ + 1;
  if (num_failed_reads_ >= kMaxFailedReads) Close("the unit does not answer with sense");
  return readings;
}

std::optional<std::string> PanTilt::CheckReady() const {
  if (state_ == PanTiltState::kReady) return std::nullopt;
  const std::string reason = state_ == PanTiltState::kClosed ? ": " + problem_ : "";
  return "the pan-tilt unit is " + std::string(ToString(state_)) + reason;
}

std::optional<std::string> PanTilt::MoveTo(const PanTiltGoal& goal) {
  if (const auto refusal = CheckReady()) return refusal;
  try {
    const std::pair<PtuAxis, std::optional<double>> moves[] = {{PtuAxis::kPan, goal.pan_rad},
                                                               {PtuAxis::kTilt, goal.tilt_rad}};
    for (const auto& [axis, angle] : moves)
      if (angle)
        if (const auto refusal = unit_->CheckAngle(axis, *angle)) return refusal;
    for (const auto& [axis, angle] : moves)
      if (angle)
        if (const auto refusal = unit_->MoveTo(axis, *angle)) return refusal;
  } catch (const std::system_error& error) {
    Close(error.what());
    return problem_;
  }
  return std::nullopt;
}

std::optional<std::string> PanTilt::Home() {
  if (const auto refusal = CheckReady()) return refusal;
  try {
    StartHoming();
  } catch (const std::system_error& error) {
    Close(error.what());
    return problem_;
  }
  return std::nullopt;
}

std::optional<PtuLinkCounts> PanTilt::counts() const {
  if (!unit_) return std::nullopt;
  return unit_->counts();
}

std::optional<PtuAxisProperties> PanTilt::properties(PtuAxis axis) const {
  if (state_ == PanTiltState::kClosed) return std::nullopt;
  return unit_->properties(axis);
}

}  // namespace arfm_vo
