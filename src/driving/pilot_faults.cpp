// The part of the pilot that decides whether the rover may move.
#include "arfm_vo/base/format.h"
#include "arfm_vo/driving/pilot.h"

namespace arfm_vo {
namespace {

/// What was stamped before the clock was set is forgotten by then, in the tf buffer too.
constexpr double kOldStamps_s = 10;

std::string Join(const std::set<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "by " : ", ") + name;
  return text;
}

/// What a pose of another epoch looks like.
bool IsJump(StopReason reason) {
  return reason == StopReason::kPoseContradiction || reason == StopReason::kSliding ||
         reason == StopReason::kMapStep;
}

}  // namespace

void Pilot::ObserveClockSet(double now_s, double step_s) {
  clock_set_s_ = now_s;
  Distrust({StopReason::kClockSet, Format("by %+.2f s", step_s)});
}

void Pilot::ObserveHalt(double now_s) {
  if (state_ == DriveState::kDriving) Pause(now_s, StopReason::kHeldUp);
}

std::vector<CheckLine> Pilot::Check(double now_s, const std::string& released) const {
  const auto chassis = chassis_.FindFault(now_s);
  const bool is_free = emergency_sources_.size() == emergency_sources_.count(released);
  const bool is_alone = operator_.IsMissing();
  const bool was_set = clock_set_s_ && now_s - *clock_set_s_ <= kOldStamps_s;
  std::vector<CheckLine> lines = {
      {"emergency_stop", is_free,
       emergency_sources_.empty()
           ? "none is set"
           : Join(emergency_sources_) + (is_free ? ", which a start ends" : "")},
      {"operator", !is_alone,
       is_alone ? "does not answer " + operator_.DescribeRefused() : "answers or is not required"},
      {"chassis", !chassis, chassis ? ToString(*chassis) : "answers"},
      {"clock", !was_set, was_set ? "was set just now" : "goes on evenly"}};
  for (CheckLine& line : pictures_.Check(now_s)) lines.push_back(std::move(line));
  return lines;
}

std::optional<Fault> Pilot::FindStartFault(double now_s) const {
  if (!emergency_sources_.empty())
    return Fault{StopReason::kEmergencyStop, Join(emergency_sources_)};
  if (operator_.IsMissing()) return Fault{StopReason::kOperatorLost, operator_.DescribeRefused()};
  return chassis_.FindFault(now_s);
}

std::optional<Fault> Pilot::FindBlockingFault(double now_s) const {
  if (const auto fault = FindStartFault(now_s)) return fault;
  const bool is_arming = state_ == DriveState::kArming;
  if (!chassis_.IsOurs() && !(is_arming && now_s - armed_s_ <= options_.arming_timeout_s))
    return Fault{StopReason::kModeLost, ""};
  if (chassis_.IsOurs())
    if (const auto fault = motion_watch_.FindFault(now_s)) return fault;
  if (pose_.IsTilted()) return Fault{StopReason::kTilt, ""};
  return state_ == DriveState::kDriving ? FindDrivingFault() : std::nullopt;
}

std::optional<Fault> Pilot::FindDrivingFault() const {
  if (const auto excess = slip_.FindExcess()) return Fault{StopReason::kSlip, *excess};
  if (progress_.IsStalled()) return Fault{StopReason::kNoProgress, ""};
  if (predicted_ && !goal_limits_.IsInsideFence(predicted_->x_m, predicted_->y_m))
    return Fault{StopReason::kOutsideFence, ""};
  return std::nullopt;
}

bool Pilot::IsVelocityFresh(double now_s) const {
  return now_s - velocity_s_ <= options_.velocity_timeout_s;
}

void Pilot::Block(const Fault& fault) {
  if (route_) Report(GoalOutcome::kBlocked, fault);
  if (state_ != DriveState::kBlocked) waiting_since_s_ = last_tick_s_;
  state_ = DriveState::kBlocked;
  why_ = fault;
  velocity_s_ = kNeverCommanded_s;
}

void Pilot::Distrust(const Fault& fault) {
  const bool keeps_route =
      fault.reason == StopReason::kMapStep || fault.reason == StopReason::kHeldUp;
  if (!keeps_route) EndRoute(GoalOutcome::kCancelled, fault);
  // Topics have no order between them: a pose of a new epoch may come before the epoch.
  const bool is_explained = state_ == DriveState::kBlocked &&
                            fault.reason == StopReason::kNewEpoch && IsJump(why_.reason);
  if (is_explained || (state_ != DriveState::kStandby && state_ != DriveState::kBlocked))
    Block(fault);
}

void Pilot::Pause(double now_s, StopReason reason) {
  if (state_ != DriveState::kPaused) pause_start_s_ = now_s;
  commanded_s_ = kNeverCommanded_s;  // whoever commanded it has seen it stop
  state_ = DriveState::kPaused;
  why_.reason = reason;
  flawed_s_ = now_s;
  stop_look_go_.Reset();
  if (now_s - pause_start_s_ > options_.max_pause_s)
    Block({StopReason::kPoseLost, std::string("(") + ToString(reason) + ")"});
}

/// After a long standby or block the world is another; says whether it is one.
bool Pilot::DropOldRoute() {
  const bool is_blocked = state_ == DriveState::kBlocked;
  if ((state_ != DriveState::kStandby && !is_blocked) || !waiting_since_s_) return false;
  if (last_tick_s_ - *waiting_since_s_ <= options_.goal_limits.max_standby_s) return false;
  EndRoute(GoalOutcome::kCancelled, is_blocked ? why_ : Fault{StopReason::kNotStarted, ""});
  return true;
}

void Pilot::JudgePose(double now_s) {
  if (const auto fault = pose_.Judge(now_s, tracks_)) {
    if (fault->reason != StopReason::kMapStep) contradicted_s_ = now_s;
    Distrust(*fault);
  }
  predicted_.reset();
  if (!pose_.HasPose()) return;
  predicted_ = pose_.PredictInMap(tracks_.At(now_s).value_or(pose_.LastSighting().ways));
  if (pose_.LastSighting().taken_s <= compared_s_) return;
  compared_s_ = pose_.LastSighting().taken_s;
  slip_.Add(pose_.LastSightingInOdom(), pose_.LastSighting().ways);
}

void Pilot::UpdateState(double now_s) {
  const bool waits = state_ == DriveState::kStandby || state_ == DriveState::kBlocked;
  const auto motion_at_rest = motion_watch_.FindMotionAtRest(now_s);
  if (motion_at_rest && why_.reason != StopReason::kRunaway) {  // which says it already
    if (!waits) Block(*motion_at_rest);
    why_ = *motion_at_rest;
  }
  DropOldRoute();
  if (state_ == DriveState::kStandby || state_ == DriveState::kBlocked) return;
  if (const auto fault = FindBlockingFault(now_s)) return Block(*fault);
  if (!chassis_.IsOurs()) return;  // arming
  const bool needs_pose = route_ || options_.velocity_needs_pose;
  const auto pose_fault = needs_pose ? pose_.FindFault(now_s) : std::nullopt;
  if (pose_fault) return Pause(now_s, *pose_fault);
  if (needs_pose && !pictures_.HasSettled() && !options_.IsOverridden("exposure"))
    return Pause(now_s, StopReason::kExposure);
  if (state_ == DriveState::kPaused && now_s - flawed_s_ < options_.resume_after_s) return;
  GoOn(now_s);
}

void Pilot::GoOn(double now_s) {
  why_.reason = StopReason::kNone;
  const bool has_work = route_ || IsVelocityFresh(now_s);
  if (!has_work) {
    state_ = DriveState::kReady;
    return;
  }
  const bool is_fresh = now_s - commanded_s_ <= options_.fresh_command_s;
  const bool was_warning = state_ == DriveState::kWarning;
  if (state_ == DriveState::kDriving || is_fresh ||
      (was_warning && now_s - warned_since_s_ >= options_.warning_s)) {
    state_ = DriveState::kDriving;
    return;
  }
  if (!was_warning) warned_since_s_ = now_s;
  state_ = DriveState::kWarning;
}

}  // namespace arfm_vo
