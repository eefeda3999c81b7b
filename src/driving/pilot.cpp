#include "arfm_vo/driving/pilot.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arfm_vo/base/format.h"

namespace arfm_vo {
namespace {

/// A late tick is not made up for by a leap of the speed.
constexpr double kMaxTick_s = 0.1;
/// Further sources of an emergency stop are not told apart: a person releases theirs.
constexpr size_t kMaxEmergencySources = 64;

PoseWatchOptions PoseOptionsFor(const PilotOptions& options) {
  PoseWatchOptions pose = options.pose;
  if (options.stop_look_go.is_on) pose.max_pose_age_s = options.stop_look_go.max_pose_age_s;
  return pose;
}

}  // namespace

Pilot::Pilot(const PilotOptions& options)
    : options_(options),
      kinematics_(options.kinematics),
      limiter_(options.limits, kinematics_),
      pose_(PoseOptionsFor(options), kinematics_),
      chassis_(options.chassis),
      motion_watch_(options.motion, options.kinematics.gauge_m),
      operator_(options.operator_watch),
      pictures_(PoseOptionsFor(options).max_pose_age_s),
      goal_limits_(options.goal_limits),
      tracks_(PoseOptionsFor(options).max_pose_age_s + 1),
      slip_(options.slip, kinematics_),
      stop_look_go_(options.stop_look_go),
      progress_(options.max_stall_s) {
  options_.Check();
}

Reply Pilot::Start(double now_s) {
  if (const auto fault = FindStartFault(now_s)) return {false, "not started: " + ToString(*fault)};
  commanded_s_ = now_s;
  if (state_ != DriveState::kStandby && state_ != DriveState::kBlocked)
    return {true, "already started"};
  if (IsVelocityFresh(now_s) && !velocity_.IsZero())
    return {false, "not started: " + velocity_source_ + " commands a velocity already"};
  DropOldRoute();
  state_ = DriveState::kArming;
  why_ = {};
  has_started_ = true;
  armed_s_ = now_s;
  pose_.AgreeOnMap();
  slip_.Reset();
  progress_.Renew();
  stop_look_go_.Reset();
  motion_watch_.Reset();
  return {true, route_ ? "started, drives to the goal" : "started"};
}

void Pilot::Stop() {
  EndRoute(GoalOutcome::kCancelled, {StopReason::kStopped, ""});
  state_ = DriveState::kStandby;
  waiting_since_s_ = last_tick_s_;
  why_ = {StopReason::kStopped, ""};
  velocity_s_ = kNeverCommanded_s;
}

void Pilot::SetEmergencyStop(const std::string& source, bool is_set) {
  if (!is_set) {
    emergency_sources_.erase(source);
  } else {
    const bool is_room = emergency_sources_.size() < kMaxEmergencySources;
    emergency_sources_.insert(is_room ? source : "further nodes");
  }
}

Reply Pilot::SetRoute(Route route) {
  if (state_ == DriveState::kBlocked)
    return {false, "goal refused: the rover is blocked: " + ToString(why_)};
  if (DropOldRoute()) return {false, "goal refused: the rover is in standby; start it first"};
  if (!predicted_) return {false, "goal refused: the rover has no pose"};
  const std::string flaw = goal_limits_.FindFlaw(route, *predicted_);
  if (!flaw.empty()) return {false, "goal refused: " + flaw};
  GoalController controller(options_.goal, std::move(route));
  EndRoute(GoalOutcome::kReplaced);
  route_ = std::move(controller);
  pose_.AgreeOnMap();
  velocity_s_ = kNeverCommanded_s;
  commanded_s_ = last_tick_s_;
  progress_.Renew();
  stop_look_go_.Reset();
  return {true, "goal taken"};
}

void Pilot::CancelRoute() { EndRoute(GoalOutcome::kCancelled); }

Reply Pilot::SetVelocity(double now_s, const PlanarMotion& motion, const std::string& source) {
  if (!motion.IsFinite()) {
    velocity_s_ = kNeverCommanded_s;
    return {false, "velocity refused: it is not finite"};
  }
  if (route_) return {false, "velocity refused: a goal is being driven to"};
  if (source != velocity_source_ && IsVelocityFresh(now_s) && !velocity_.IsZero()) {
    velocity_s_ = kNeverCommanded_s;
    Distrust({StopReason::kVelocityConflict, "(" + velocity_source_ + ", " + source + ")"});
    return {false, std::string("velocity refused: ") + ToString(StopReason::kVelocityConflict)};
  }
  velocity_ = motion;
  velocity_source_ = source;
  velocity_s_ = now_s;
  // What streams on through a pause is no new command.
  if (state_ != DriveState::kPaused && state_ != DriveState::kWarning) commanded_s_ = now_s;
  return {true, ""};
}

Reply Pilot::SetDatum() {
  if (state_ == DriveState::kDriving || state_ == DriveState::kWarning)
    return {false, "datum refused: the rover drives"};
  const auto pose = pose_.SetDatum();
  if (!pose) return {false, "datum refused: the rover has no pose"};
  return {true, Format("the rover stands at x %.2f m, y %.2f m, heading %.0f deg", pose->x_m,
                       pose->y_m, pose->heading_rad * 180 / M_PI)};
}

void Pilot::ObserveEpoch(uint32_t epoch, double taken_s) {
  if (!pose_.ObserveEpoch(epoch, taken_s)) return;
  slip_.Reset();
  Distrust({StopReason::kNewEpoch, "(epoch " + std::to_string(epoch) + ")"});
  predicted_.reset();
}

bool Pilot::ObserveUncertainty(double now_s, const PoseUncertainty& uncertainty) {
  return pose_.Observe(now_s, uncertainty);
}

void Pilot::ObserveTracks(double now_s, int left_mm, int right_mm) {
  tracks_.Add(now_s, left_mm, right_mm);
  motion_watch_.ObserveWays(*tracks_.At(now_s));
  chassis_.ObserveFeedback(now_s, FeedbackKind::kOdometer);
}

void Pilot::Report(GoalOutcome outcome, const Fault& fault) {
  GoalResult result;
  result.outcome = outcome;
  result.reason = fault.reason;
  result.detail = fault.detail;
  result.goal = route_->Waypoints().back();
  if (predicted_) {
    result.position_error_m =
        std::hypot(result.goal.x_m - predicted_->x_m, result.goal.y_m - predicted_->y_m);
    result.heading_error_rad = route_->GoalHeadingError(*predicted_);
  }
  results_.push_back(result);
}

void Pilot::EndRoute(GoalOutcome outcome, const Fault& fault) {
  if (!route_) return;
  Report(outcome, fault);
  route_.reset();
}

bool Pilot::IsSeenAtRest() const {
  return pose_.HasPose() && pose_.LastSighting().taken_s >= at_rest_since_s_ + options_.settle_s;
}

PlanarMotion Pilot::WantedMotion(double now_s) {
  const bool is_at_rest = IsSeenAtRest();
  PlanarMotion wanted = velocity_;
  if (route_) {
    wanted = route_->Update(*predicted_, is_at_rest);
    const int stage =
        static_cast<int>(route_->NextWaypoint()) * 8 + static_cast<int>(route_->Phase());
    progress_.Observe(driven_s_, stage, route_->Cost(*predicted_));
    if (route_->HasArrived()) {
      EndRoute(GoalOutcome::kArrived);
      return {};
    }
  }
  return stop_look_go_.Gate(wanted, tracks_.At(now_s).value_or(TrackWays{}), is_at_rest);
}

DriveCommand Pilot::Tick(double now_s) {
  const double dt_s = std::clamp(now_s - last_tick_s_, 0.0, kMaxTick_s);
  const bool was_held_up = waiting_since_s_ && now_s - last_tick_s_ > options_.max_tick_gap_s;
  last_tick_s_ = now_s;
  if (was_held_up) Distrust({StopReason::kHeldUp, ""});
  if (!waiting_since_s_) waiting_since_s_ = now_s;
  JudgePose(now_s);
  UpdateState(now_s);
  PlanarMotion motion;
  if (state_ == DriveState::kDriving) {
    motion = limiter_.Limit(WantedMotion(now_s), dt_s);
  } else {
    limiter_.Halt();
  }
  if (!motion.IsZero()) {
    at_rest_since_s_ = now_s;
    driven_s_ += dt_s;
  }
  motion_ = motion;
  const bool is_lamp_on = state_ == DriveState::kWarning || state_ == DriveState::kDriving;
  const DriveCommand command{has_started_, state_ != DriveState::kStandby,
                             kinematics_.ChassisMotionFor(motion), is_lamp_on};
  motion_watch_.ObserveRest(now_s, motion.IsZero() && chassis_.IsNobodyElses());
  if (has_started_ && chassis_.IsOurs())
    motion_watch_.ObserveCommand(now_s, command.chassis_motion);
  return command;
}

PilotStatus Pilot::Status() const {
  PilotStatus status;
  status.state = state_;
  status.reason = why_.reason;
  status.detail = why_.detail;
  status.has_goal = route_.has_value();
  status.motion = motion_;
  status.slip = slip_.Estimate();
  status.contradicted_s = contradicted_s_;
  status.operator_round_trip_s = operator_.RoundTrip();
  status.is_tilt_near_limit = pose_.IsTiltNearLimit();
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
