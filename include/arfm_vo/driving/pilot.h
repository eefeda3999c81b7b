#pragma once

#include <limits>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "arfm_vo/driving/picture_watch.h"
#include "arfm_vo/driving/pilot_options.h"
#include "arfm_vo/driving/pilot_status.h"
#include "arfm_vo/driving/progress_watch.h"
#include "arfm_vo/driving/track_history.h"

namespace arfm_vo {

/// Decides what moves the rover: a route, a velocity command, or nothing. Nothing moves before
/// Start, and Stop always wins. A pose that is missing pauses the drive: after a short pause it
/// goes on by itself, with a warning first, where the pose agrees with the tracks. A pose that is
/// wrong drops the goal and blocks; every other fault blocks too, until it is started again.
/// Has no clock of its own: `now_s` never jumps, and Tick is to be called every 20 ms.
class Pilot {
 public:
  explicit Pilot(const PilotOptions& options);

  /// Refused where a fault, other than of the pose, is there now, and without an operator.
  Reply Start(double now_s);
  /// Drops the route, and stays in standby until Start.
  void Stop();
  /// Stays set until the same `source` clears it, or a person releases them all.
  void SetEmergencyStop(const std::string& source, bool is_set);
  void ReleaseEmergencyStops() { emergency_sources_.clear(); }
  /// Replaces the route; it is driven to as soon as nothing speaks against it. Refused while
  /// blocked, in a long standby, without a pose, and beyond the goal limits. Throws
  /// std::invalid_argument where it is empty.
  Reply SetRoute(Route route);
  void CancelRoute();
  /// A velocity of the base, to be renewed within velocity_timeout_s. Refused while there is a
  /// route, and where it is not finite. Blocks where another `source` moves the rover at that time.
  Reply SetVelocity(double now_s, const PlanarMotion& motion, const std::string& source = "");
  /// A person has confirmed the pose that the map shows: its uncertainty counts from here. Refused
  /// while the rover moves and without a pose.
  Reply SetDatum();

  /// Has a clock of its own, which runs where that of driving stands.
  OperatorWatch& operator_watch() { return operator_; }
  const OperatorWatch& operator_watch() const { return operator_; }
  void ObservePose(double now_s, const PoseObservation& pose) { pose_.Observe(now_s, pose); }
  void ObserveNoPose(StopReason reason = StopReason::kPoseMissing) { pose_.ObserveNone(reason); }
  /// Says whether it was taken: one from the future is not.
  bool ObserveUncertainty(double now_s, const PoseUncertainty& uncertainty);
  /// Of the odometry, with a pair of `taken_s`. Another than before drops the goal and blocks.
  void ObserveEpoch(uint32_t epoch, double taken_s);
  void ObserveTracks(double now_s, int left_mm, int right_mm);
  /// Commands came late and chassis_guard has halted the rover: a drive pauses.
  void ObserveHalt(double now_s);
  /// The computer's clock was set by `step_s`: drops the goal and blocks.
  void ObserveClockSet(double now_s, double step_s);
  PictureWatch& picture_watch() { return pictures_; }
  /// Of the bus, of other drivers, and of the age of all other feedback.
  ChassisWatch& chassis_watch() { return chassis_; }
  /// What the chassis measures of its own motion.
  MotionWatch& motion_watch() { return motion_watch_; }

  DriveCommand Tick(double now_s);
  /// The start-up check, as far as the watches know; Start looks at a part of it. An emergency stop
  /// by `released` alone is none: who starts the rover clears it before.
  std::vector<CheckLine> Check(double now_s, const std::string& released = "") const;

  PilotStatus Status() const;
  /// What became of goals since the last call.
  std::vector<GoalResult> TakeResults();

 private:
  static constexpr double kNeverCommanded_s = -std::numeric_limits<double>::infinity();
  std::optional<Fault> FindStartFault(double now_s) const;
  std::optional<Fault> FindBlockingFault(double now_s) const;
  std::optional<Fault> FindDrivingFault() const;
  void JudgePose(double now_s);
  void UpdateState(double now_s);
  void GoOn(double now_s);
  void Distrust(const Fault& fault);
  void Block(const Fault& fault);
  void Pause(double now_s, StopReason reason);
  void EndRoute(GoalOutcome outcome, const Fault& fault = {});
  void Report(GoalOutcome outcome, const Fault& fault);
  bool IsVelocityFresh(double now_s) const;
  bool DropOldRoute();
  bool IsSeenAtRest() const;
  PlanarMotion WantedMotion(double now_s);

  PilotOptions options_;
  TrackKinematics kinematics_;
  SpeedLimiter limiter_;
  PoseWatch pose_;
  ChassisWatch chassis_;
  MotionWatch motion_watch_;
  OperatorWatch operator_;
  PictureWatch pictures_;
  GoalLimits goal_limits_;
  TrackHistory tracks_;
  SlipEstimator slip_;
  StopLookGo stop_look_go_;
  ProgressWatch progress_;
  DriveState state_ = DriveState::kStandby;
  Fault why_{StopReason::kNotStarted, ""};
  bool has_started_ = false;
  std::set<std::string> emergency_sources_;
  std::optional<GoalController> route_;
  std::optional<RoverPose> predicted_;
  PlanarMotion velocity_, motion_;
  std::string velocity_source_;
  double velocity_s_ = kNeverCommanded_s, commanded_s_ = kNeverCommanded_s;
  double armed_s_ = 0, pause_start_s_ = 0, flawed_s_ = 0, warned_since_s_ = 0, compared_s_ = 0;
  double last_tick_s_ = 0, driven_s_ = 0, at_rest_since_s_ = 0;
  std::optional<double> waiting_since_s_, contradicted_s_, clock_set_s_;
  std::vector<GoalResult> results_;
};

}  // namespace arfm_vo
