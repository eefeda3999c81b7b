#include "arfm_vo/driving/pilot.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace arfm_vo {
namespace {

/// A late tick is not made up for by a leap of the speed.
constexpr double kMaxTick_s = 0.1;
constexpr double kNever_s = -std::numeric_limits<double>::infinity();

PoseWatchOptions PoseOptionsFor(const PilotOptions& options) {
  PoseWatchOptions pose = options.pose;
  if (options.stop_look_go.is_on) pose.max_pose_age_s = options.stop_look_go.max_pose_age_s;
  return pose;
}

}  // namespace

void PilotOptions::Check() const {
  kinematics.Check();
  limits.Check();
  goal.Check();
  stop_look_go.Check();
  slip.Check();
  pose.Check();
  chassis.Check();
  Require(settle_s >= 0 && settle_s <= 60, "settle_s must be in 0..60");
  Require(resume_after_s >= 0 && resume_after_s <= 60, "resume_after_s must be in 0..60");
  Require(max_pause_s >= 0, "max_pause_s must not be negative");
  Require(arming_timeout_s >= 0.2 && arming_timeout_s <= 60, "arming_timeout_s must be in 0.2..60");
  Require(max_stall_s >= 1, "max_stall_s must be at least 1");
  Require(velocity_timeout_s >= 0.05 && velocity_timeout_s <= 0.18,
          "velocity_timeout_s must be in 0.05..0.18: the rover must stand within 0.2 s");
}

Pilot::Pilot(const PilotOptions& options)
    : options_(options),
      kinematics_(options.kinematics),
      limiter_(options.limits, kinematics_),
      pose_(PoseOptionsFor(options)),
      chassis_(options.chassis),
      tracks_(PoseOptionsFor(options).max_pose_age_s + 1),
      slip_(options.slip, kinematics_),
      stop_look_go_(options.stop_look_go),
      progress_(options.max_stall_s),
      velocity_s_(kNever_s) {
  options_.Check();
}

Reply Pilot::Start(double now_s) {
  if (is_emergency_stop_)
    return {false, std::string("not started: ") + ToString(StopReason::kEmergencyStop)};
  if (const auto fault = chassis_.FindFault(now_s))
    return {false, std::string("not started: ") + ToString(*fault)};
  if (state_ != DriveState::kStandby && state_ != DriveState::kBlocked)
    return {true, "already started"};
  state_ = DriveState::kArming;
  reason_ = StopReason::kNone;
  has_started_ = true;
  armed_s_ = now_s;
  slip_.Reset();
  progress_.Renew();
  stop_look_go_.Reset();
  return {true, route_ ? "started, drives to the goal" : "started"};
}

void Pilot::Stop() {
  EndRoute(GoalOutcome::kCancelled, StopReason::kStopped);
  state_ = DriveState::kStandby;
  reason_ = StopReason::kStopped;
  velocity_s_ = kNever_s;
}

void Pilot::SetRoute(Route route) {
  GoalController controller(options_.goal, std::move(route));
  EndRoute(GoalOutcome::kReplaced, StopReason::kNone);
  route_ = std::move(controller);
  velocity_s_ = kNever_s;
  progress_.Renew();
  stop_look_go_.Reset();
}

void Pilot::CancelRoute() { EndRoute(GoalOutcome::kCancelled, StopReason::kNone); }

Reply Pilot::SetVelocity(double now_s, const PlanarMotion& motion) {
  if (!motion.IsFinite()) {
    velocity_s_ = kNever_s;
    return {false, "velocity refused: it is not finite"};
  }
  if (route_) return {false, "velocity refused: a goal is being driven to"};
  velocity_ = motion;
  velocity_s_ = now_s;
  return {true, ""};
}

void Pilot::ObserveOdometry(double taken_s, const Rigid3& odom_from_base) {
  if (!odom_from_base.IsFinite() || !tracks_.Covers(taken_s)) return;
  slip_.Add(odom_from_base, *tracks_.At(taken_s));
}

void Pilot::ObserveTracks(double now_s, int left_mm, int right_mm) {
  tracks_.Add(now_s, left_mm, right_mm);
  chassis_.ObserveTrackOdometer(now_s);
}

void Pilot::Report(GoalOutcome outcome, StopReason reason) {
  GoalResult result{outcome, reason, route_->Waypoints().back()};
  if (predicted_) {
    result.position_error_m =
        std::hypot(result.goal.x_m - predicted_->x_m, result.goal.y_m - predicted_->y_m);
    result.heading_error_rad = route_->GoalHeadingError(*predicted_);
  }
  results_.push_back(result);
}

void Pilot::EndRoute(GoalOutcome outcome, StopReason reason) {
  if (!route_) return;
  Report(outcome, reason);
  route_.reset();
}

void Pilot::Block(StopReason reason) {
  if (route_) Report(GoalOutcome::kBlocked, reason);
  state_ = DriveState::kBlocked;
  reason_ = reason;
  velocity_s_ = kNever_s;
}

void Pilot::Pause(double now_s, StopReason reason) {
  if (state_ != DriveState::kPaused) pause_start_s_ = now_s;
  state_ = DriveState::kPaused;
  reason_ = reason;
  flawed_s_ = now_s;
  stop_look_go_.Reset();
  if (route_ && now_s - pause_start_s_ > options_.max_pause_s) Block(StopReason::kPoseLost);
}

std::optional<StopReason> Pilot::FindBlockingFault(double now_s) const {
  if (is_emergency_stop_) return StopReason::kEmergencyStop;
  if (const auto fault = chassis_.FindFault(now_s)) return fault;
  const bool is_arming = state_ == DriveState::kArming;
  if (!chassis_.IsOurs() && !(is_arming && now_s - armed_s_ <= options_.arming_timeout_s))
    return StopReason::kModeLost;
  if (state_ != DriveState::kDriving) return std::nullopt;
  if (slip_.IsExcessive()) return StopReason::kSlip;
  if (progress_.IsStalled()) return StopReason::kNoProgress;
  return std::nullopt;
}

bool Pilot::IsVelocityFresh(double now_s) const {
  return now_s - velocity_s_ <= options_.velocity_timeout_s;
}

void Pilot::UpdateState(double now_s) {
  if (state_ == DriveState::kStandby || state_ == DriveState::kBlocked) return;
  if (const auto fault = FindBlockingFault(now_s)) return Block(*fault);
  if (!chassis_.IsOurs()) return;  // arming
  const bool needs_pose = route_ || options_.velocity_needs_pose;
  const auto pose_fault = needs_pose ? pose_.FindFault(now_s) : std::nullopt;
  if (pose_fault) return Pause(now_s, *pose_fault);
  if (state_ == DriveState::kPaused && now_s - flawed_s_ < options_.resume_after_s) return;
  const bool has_work = route_ || IsVelocityFresh(now_s);
  state_ = has_work ? DriveState::kDriving : DriveState::kReady;
  reason_ = StopReason::kNone;
}

RoverPose Pilot::PredictPose(double now_s) const {
  const PoseObservation& seen = *pose_.Pose();
  const RoverPose pose = ProjectToPlane(seen.map_from_base);
  const auto then = tracks_.At(seen.taken_s), now = tracks_.At(now_s);
  if (!then || !now) return pose;
  const PlanarMotion way =
      kinematics_.MotionOf({now->left_m - then->left_m, now->right_m - then->right_m});
  return Advance(pose, way.forward_mps, way.turn_radps);
}

bool Pilot::IsSeenAtRest() const {
  return pose_.Pose()->taken_s >= at_rest_since_s_ + options_.settle_s;
}

PlanarMotion Pilot::RouteMotion(double now_s) {
  const bool is_at_rest = IsSeenAtRest();
  const PlanarMotion wanted = route_->Update(*predicted_, is_at_rest);
  const int stage =
      static_cast<int>(route_->NextWaypoint()) * 8 + static_cast<int>(route_->Phase());
  progress_.Observe(driven_s_, stage, route_->Cost(*predicted_));
  if (route_->HasArrived()) {
    EndRoute(GoalOutcome::kArrived, StopReason::kNone);
    return {};
  }
  return stop_look_go_.Gate(wanted, tracks_.At(now_s).value_or(TrackWays{}), is_at_rest);
}

void Pilot::NoteMotion(double now_s, double dt_s, const PlanarMotion& motion) {
  if (!motion.IsZero()) {
    at_rest_since_s_ = now_s;
    driven_s_ += dt_s;
  }
  motion_ = motion;
}

DriveCommand Pilot::Tick(double now_s) {
  const double dt_s = std::clamp(now_s - last_tick_s_, 0.0, kMaxTick_s);
  last_tick_s_ = now_s;
  UpdateState(now_s);
  predicted_ = pose_.Pose() ? std::optional(PredictPose(now_s)) : std::nullopt;
  PlanarMotion motion;
  if (state_ == DriveState::kDriving) {
    motion = limiter_.Limit(route_ ? RouteMotion(now_s) : velocity_, dt_s);
  } else {
    limiter_.Halt();
  }
  NoteMotion(now_s, dt_s, motion);
  return {has_started_, state_ != DriveState::kStandby, kinematics_.ChassisMotionFor(motion)};
}

PilotStatus Pilot::Status() const {
  PilotStatus status;
  status.state = state_;
  status.reason = reason_;
  status.has_goal = route_.has_value();
  status.motion = motion_;
  status.slip = slip_.Estimate();
  if (route_) {
    status.phase = route_->Phase();
    status.next_waypoint = route_->NextWaypoint();
    status.num_waypoints = route_->Waypoints().size();
    if (predicted_) {
      status.distance_to_goal_m = route_->RemainingDistance(*predicted_);
      status.heading_error_rad = route_->GoalHeadingError(*predicted_);
    }
  }
  return status;
}

std::vector<GoalResult> Pilot::TakeResults() { return std::exchange(results_, {}); }

}  // namespace arfm_vo
