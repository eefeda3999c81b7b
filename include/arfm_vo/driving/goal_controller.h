#pragma once

#include "arfm_vo/base/fields.h"
#include "arfm_vo/driving/planar_motion.h"
#include "arfm_vo/driving/route.h"

namespace arfm_vo {

struct GoalControllerOptions {
  double position_tolerance_m = 0.03;   ///< error at which a goal is reached
  double heading_tolerance_rad = 0.03;  ///< the same of the heading
  double waypoint_tolerance_m = 0.15;   ///< how near a waypoint before the last must be passed
  double cruise_speed_mps = 0.1;        ///< far from the goal
  double max_backward_m = 0.8;          ///< farther goals are never driven to backward; 0: none

  void Check() const;
  ARFM_FIELDS(position_tolerance_m, heading_tolerance_rad, waypoint_tolerance_m, cruise_speed_mps,
              max_backward_m)
};

/// What the controller is at. From the last waypoint's position the order is heading, settle,
/// arrived; where settling shows the rover off its goal, it goes back to the first.
enum class DrivePhase {
  kTurnToWaypoint,  ///< turns in place until the waypoint lies ahead (or behind)
  kDrive,           ///< drives at the waypoint
  kTurnToHeading,   ///< turns in place to the goal's heading
  kSettle,          ///< stands still until a pose taken at rest confirms the goal
  kArrived,
};

const char* ToString(DrivePhase phase);

/// Steers a skid-steered rover along a route: turn in place, drive, turn in place. Knows nothing of
/// time: the wanted motion follows from the pose alone.
class GoalController {
 public:
  /// Throws std::invalid_argument where `route` is empty or an option is wrong.
  GoalController(const GoalControllerOptions& options, Route route);

  /// The motion wanted at `pose`; `is_at_rest` says that the rover has settled and that `pose` was
  /// seen since.
  PlanarMotion Update(const RoverPose& pose, bool is_at_rest);

  DrivePhase Phase() const { return phase_; }
  bool HasArrived() const { return phase_ == DrivePhase::kArrived; }
  size_t NextWaypoint() const { return next_; }
  const Route& Waypoints() const { return route_; }

  /// The way to go over all waypoints, m, straight from each to the next.
  double RemainingDistance(const RoverPose& pose) const;
  /// The turn from `pose` to the goal's heading, rad; 0 where the goal has none.
  double GoalHeadingError(const RoverPose& pose) const;
  /// Falls while the controller gets on within a phase: the way to go, and 0.3 m for each rad.
  double Cost(const RoverPose& pose) const;

 private:
  bool IsLast() const { return next_ + 1 == route_.size(); }
  double DistanceToWaypoint(const RoverPose& pose) const;
  /// From the rover's driving direction (forward or backward) to the waypoint.
  double BearingError(const RoverPose& pose) const;
  bool IsBetterBackward(const RoverPose& pose) const;
  void BeginLeg(const RoverPose& pose);
  void Advance(const RoverPose& pose, bool is_at_rest);
  void FollowLeg(const RoverPose& pose);
  void JudgeRest(const RoverPose& pose);
  double TurnRate(double error_rad) const;
  PlanarMotion DriveMotion(const RoverPose& pose) const;

  GoalControllerOptions options_;
  Route route_;
  size_t next_ = 0;
  DrivePhase phase_ = DrivePhase::kTurnToWaypoint;
  bool is_leg_begun_ = false;
  bool is_backward_ = false;
};

}  // namespace arfm_vo
