#pragma once

#include <optional>
#include <string>
#include <vector>

#include "arfm_vo/driving/pilot_options.h"
#include "arfm_vo/driving/progress_watch.h"
#include "arfm_vo/driving/track_history.h"

namespace arfm_vo {

/// What is to be told to the chassis now.
struct DriveCommand {
  /// False until the first start: not a single frame may be sent.
  bool may_speak = false;
  /// The chassis is to take our commands; where it does not, it must be asked (again).
  bool wants_authority = false;
  /// The motion as the chassis takes it, its turn rate raised for the skidding of the tracks.
  PlanarMotion chassis_motion;
};

/// Whether a request was taken, and why (not), in words.
struct Reply {
  bool is_accepted = false;
  std::string text;
};

struct GoalResult {
  GoalOutcome outcome = GoalOutcome::kArrived;
  StopReason reason = StopReason::kNone;
  Waypoint goal;
  double position_error_m = 0;  ///< by sight
  double heading_error_rad = 0;
};

struct PilotStatus {
  DriveState state = DriveState::kStandby;
  StopReason reason = StopReason::kNotStarted;
  bool has_goal = false;
  DrivePhase phase = DrivePhase::kTurnToWaypoint;  ///< these five hold with a goal and a pose only
  size_t next_waypoint = 0, num_waypoints = 0;
  double distance_to_goal_m = 0;
  double heading_error_rad = 0;
  PlanarMotion motion;  ///< commanded, of the base
  std::optional<Slip> slip;
};

/// Decides what moves the rover: a route, a velocity command, or nothing. Nothing moves before
/// Start, and Stop always wins. A fault of the pose pauses the drive, and it goes on by itself when
/// the pose has been good again for a while; every other fault blocks it until it is started again.
/// Has no clock of its own: `now_s` is a time that never jumps, and Tick is to be called every 20
/// ms.
class Pilot {
 public:
  explicit Pilot(const PilotOptions& options);

  /// Refused where a fault, other than of the pose, is there now.
  Reply Start(double now_s);
  /// Drops the route, and stays in standby until Start.
  void Stop();
  void SetEmergencyStop(bool is_set) { is_emergency_stop_ = is_set; }
  /// Replaces the route; it is driven to as soon as nothing speaks against it. Throws
  /// std::invalid_argument where it is empty.
  void SetRoute(Route route);
  void CancelRoute();
  /// A velocity of the base, to be renewed within velocity_timeout_s. Refused while there is a
  /// route, and where it is not finite.
  Reply SetVelocity(double now_s, const PlanarMotion& motion);

  void ObservePose(double now_s, const PoseObservation& pose) { pose_.Observe(now_s, pose); }
  void ObserveNoPose() { pose_.ObserveNone(); }
  void ObserveUncertainty(const PoseUncertainty& uncertainty) { pose_.Observe(uncertainty); }
  /// The pose by sight in a frame where it never jumps, for the slip.
  void ObserveOdometry(double taken_s, const Rigid3& odom_from_base);
  void ObserveChassis(double now_s, const ChassisStatus& status) {
    chassis_.Observe(now_s, status);
  }
  void ObserveTracks(double now_s, int left_mm, int right_mm);
  void ObserveBus(bool is_up) { chassis_.ObserveBus(is_up); }

  DriveCommand Tick(double now_s);

  PilotStatus Status() const;
  /// What became of goals since the last call.
  std::vector<GoalResult> TakeResults();

 private:
  std::optional<StopReason> FindBlockingFault(double now_s) const;
  void UpdateState(double now_s);
  void Block(StopReason reason);
  void Pause(double now_s, StopReason reason);
  void EndRoute(GoalOutcome outcome, StopReason reason);
  void Report(GoalOutcome outcome, StopReason reason);
  bool IsVelocityFresh(double now_s) const;
  RoverPose PredictPose(double now_s) const;
  bool IsSeenAtRest() const;
  PlanarMotion RouteMotion(double now_s);
  void NoteMotion(double now_s, double dt_s, const PlanarMotion& motion);

  PilotOptions options_;
  TrackKinematics kinematics_;
  SpeedLimiter limiter_;
  PoseWatch pose_;
  ChassisWatch chassis_;
  TrackHistory tracks_;
  SlipEstimator slip_;
  StopLookGo stop_look_go_;
  ProgressWatch progress_;

  DriveState state_ = DriveState::kStandby;
  StopReason reason_ = StopReason::kNotStarted;
  bool has_started_ = false;
  bool is_emergency_stop_ = false;
  std::optional<GoalController> route_;
  std::optional<RoverPose> predicted_;
  PlanarMotion velocity_, motion_;
  double velocity_s_ = 0, armed_s_ = 0, pause_start_s_ = 0, flawed_s_ = 0;
  double last_tick_s_ = 0, driven_s_ = 0, at_rest_since_s_ = 0;
  std::vector<GoalResult> results_;
};

}  // namespace arfm_vo
