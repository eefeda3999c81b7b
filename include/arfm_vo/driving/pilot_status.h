#pragma once

#include <optional>
#include <string>

#include "arfm_vo/driving/drive_state.h"
#include "arfm_vo/driving/goal_controller.h"
#include "arfm_vo/driving/planar_motion.h"
#include "arfm_vo/driving/slip_estimator.h"

namespace arfm_vo {

/// What is to be told to the chassis now.
struct DriveCommand {
  /// False until the first start: not a single frame may be sent.
  bool may_speak = false;
  /// The chassis is to take our commands; where it does not, it must be asked (again).
  bool wants_authority = false;
  /// The motion as the chassis takes it, its turn rate raised for the skidding of the tracks.
  PlanarMotion chassis_motion;
  /// Lamp and horn: the rover moves, or is about to.
  bool is_lamp_on = false;
};

/// Whether a request was taken, and why (not), in words.
struct Reply {
  bool is_accepted = false;
  std::string text;
};

struct GoalResult {
  GoalOutcome outcome = GoalOutcome::kArrived;
  StopReason reason = StopReason::kNone;
  std::string detail;  ///< what the reason measured; may be empty
  Waypoint goal;
  double position_error_m = 0;  ///< by sight
  double heading_error_rad = 0;
};

struct PilotStatus {
  DriveState state = DriveState::kStandby;
  StopReason reason = StopReason::kNotStarted;
  std::string detail;  ///< what the reason measured; may be empty
  bool has_goal = false;
  DrivePhase phase = DrivePhase::kTurnToWaypoint;  ///< these five hold with a goal and a pose only
  size_t next_waypoint = 0, num_waypoints = 0;
  double distance_to_goal_m = 0;
  double heading_error_rad = 0;
  PlanarMotion motion;  ///< commanded, of the base
  std::optional<Slip> slip;
  bool is_tilt_near_limit = false;
  std::optional<double> contradicted_s;         ///< when the pose last contradicted the tracks
  std::optional<double> operator_round_trip_s;  ///< nothing without an operator
};

}  // namespace arfm_vo
