#include "arfm_vo/driving/goal_controller.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "arfm_vo/base/range_check.h"

namespace arfm_vo {
namespace {

constexpr double kCruiseTurnRate_radps = 0.15;  ///< turning in place
constexpr double kMinSpeed_mps = 0.015;         ///< slower than this a goal is not approached
constexpr double kMinTurnRate_radps = 0.03;     ///< slower than this the rover does not turn
constexpr double kApproachGain_per_s = 0.5;     ///< speed over distance to go near the goal
constexpr double kTurnGain_per_s = 0.8;         ///< turn rate over heading error
constexpr double kAlign_rad = 0.05;             ///< heading error at which driving begins
constexpr double kTurnInPlace_rad = 0.4;        ///< heading error at which the rover stops to turn
constexpr double kCostPerRadian_m = 0.3;
/// Tolerances widen by this at rest, so that noise does not drive the rover to and fro.
constexpr double kSettledSlack = 1.5;

double BearingTo(const Waypoint& waypoint, const RoverPose& pose) {
  return std::atan2(waypoint.y_m - pose.y_m, waypoint.x_m - pose.x_m);
}

}  // namespace

void GoalControllerOptions::Check() const {
  RequireInRange(position_tolerance_m, 0.001, 10, "goal.position_tolerance_m");
  RequireInRange(heading_tolerance_rad, 0.001, M_PI, "goal.heading_tolerance_rad");
  RequireInRange(waypoint_tolerance_m, position_tolerance_m, 10, "goal.waypoint_tolerance_m");
  RequireInRange(cruise_speed_mps, kMinSpeed_mps, 0.1, "goal.cruise_speed_mps");
  RequireInRange(max_backward_m, 0, 1000, "goal.max_backward_m");
}

const char* ToString(DrivePhase phase) {
  constexpr const char* kNames[] = {"turning to the waypoint", "driving",
                                    "turning to the goal's heading", "settling", "arrived"};
  static_assert(std::size(kNames) == static_cast<size_t>(DrivePhase::kArrived) + 1);
  return kNames[static_cast<size_t>(phase)];
}

GoalController::GoalController(const GoalControllerOptions& options, Route route)
    : options_(options), route_(std::move(route)) {
  options_.Check();
  Require(!route_.empty(), "a route needs at least one waypoint");
}

double GoalController::DistanceToWaypoint(const RoverPose& pose) const {
  return std::hypot(route_[next_].x_m - pose.x_m, route_[next_].y_m - pose.y_m);
}

double GoalController::BearingError(const RoverPose& pose) const {
  return WrapAngle(BearingTo(route_[next_], pose) - pose.heading_rad + (is_backward_ ? M_PI : 0));
}

double GoalController::RemainingDistance(const RoverPose& pose) const {
  double distance_m = DistanceToWaypoint(pose);
  for (size_t i = next_ + 1; i < route_.size(); ++i)
    distance_m += std::hypot(route_[i].x_m - route_[i - 1].x_m, route_[i].y_m - route_[i - 1].y_m);
  return distance_m;
}

double GoalController::GoalHeadingError(const RoverPose& pose) const {
  const auto& heading_rad = route_.back().heading_rad;
  return heading_rad ? WrapAngle(*heading_rad - pose.heading_rad) : 0;
}

double GoalController::Cost(const RoverPose& pose) const {
  const double turn_rad = phase_ == DrivePhase::kTurnToHeading    ? GoalHeadingError(pose)
                          : phase_ == DrivePhase::kTurnToWaypoint ? BearingError(pose)
                                                                  : 0;
  return RemainingDistance(pose) + kCostPerRadian_m * std::abs(turn_rad);
}

bool GoalController::IsBetterBackward(const RoverPose& pose) const {
  if (DistanceToWaypoint(pose) > options_.max_backward_m) return false;
  const double bearing_rad = BearingTo(route_[next_], pose);
  const auto total_turn = [&](double direction_rad) {
    double turn_rad = std::abs(WrapAngle(direction_rad - pose.heading_rad));
    if (IsLast() && route_[next_].heading_rad)
      turn_rad += std::abs(WrapAngle(*route_[next_].heading_rad - direction_rad));
    return turn_rad;
  };
  return total_turn(bearing_rad + M_PI) < total_turn(bearing_rad);
}

void GoalController::BeginLeg(const RoverPose& pose) {
  phase_ = DrivePhase::kTurnToWaypoint;
  is_backward_ = IsBetterBackward(pose);
}

void GoalController::FollowLeg(const RoverPose& pose) {
  while (!IsLast() && DistanceToWaypoint(pose) <= options_.waypoint_tolerance_m) {
    ++next_;
    BeginLeg(pose);
  }
  if (IsLast() && DistanceToWaypoint(pose) <= options_.position_tolerance_m) {
    phase_ = DrivePhase::kTurnToHeading;
  } else if (phase_ == DrivePhase::kDrive) {
    if (std::abs(BearingError(pose)) > kTurnInPlace_rad) BeginLeg(pose);
  } else if (std::abs(BearingError(pose)) <= kAlign_rad) {
    phase_ = DrivePhase::kDrive;
  }
}

void GoalController::JudgeRest(const RoverPose& pose) {
  if (DistanceToWaypoint(pose) > kSettledSlack * options_.position_tolerance_m) {
    BeginLeg(pose);
  } else if (std::abs(GoalHeadingError(pose)) > kSettledSlack * options_.heading_tolerance_rad) {
    phase_ = DrivePhase::kTurnToHeading;
  } else {
    phase_ = DrivePhase::kArrived;
  }
}

void GoalController::Advance(const RoverPose& pose, bool is_at_rest) {
  if (!is_leg_begun_) BeginLeg(pose);
  is_leg_begun_ = true;
  if (phase_ == DrivePhase::kSettle && is_at_rest) JudgeRest(pose);
  if (phase_ == DrivePhase::kTurnToWaypoint || phase_ == DrivePhase::kDrive) FollowLeg(pose);
  if (phase_ == DrivePhase::kTurnToHeading &&
      std::abs(GoalHeadingError(pose)) <= options_.heading_tolerance_rad)
    phase_ = DrivePhase::kSettle;
}

double GoalController::TurnRate(double error_rad) const {
  const double rate_radps =
      std::clamp(kTurnGain_per_s * std::abs(error_rad), kMinTurnRate_radps, kCruiseTurnRate_radps);
  return std::copysign(rate_radps, error_rad);
}

PlanarMotion GoalController::DriveMotion(const RoverPose& pose) const {
  const double error_rad = BearingError(pose);
  double speed_mps = options_.cruise_speed_mps * std::max(0.0, std::cos(2 * error_rad));
  if (IsLast()) speed_mps = std::min(speed_mps, kApproachGain_per_s * DistanceToWaypoint(pose));
  speed_mps = std::max(speed_mps, kMinSpeed_mps);
  const double turn_radps =
      std::clamp(kTurnGain_per_s * error_rad, -kCruiseTurnRate_radps, kCruiseTurnRate_radps);
  return {is_backward_ ? -speed_mps : speed_mps, turn_radps};
}

PlanarMotion GoalController::Update(const RoverPose& pose, bool is_at_rest) {
  Advance(pose, is_at_rest);
  switch (phase_) {
    case DrivePhase::kTurnToWaypoint:
      return {0, TurnRate(BearingError(pose))};
    case DrivePhase::kDrive:
      return DriveMotion(pose);
    case DrivePhase::kTurnToHeading:
      return {0, TurnRate(GoalHeadingError(pose))};
    case DrivePhase::kSettle:
    case DrivePhase::kArrived:
      break;
  }
  return {};
}

}  // namespace arfm_vo
