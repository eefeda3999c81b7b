#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "arfm_vo/driving/chassis_watch.h"
#include "arfm_vo/driving/goal_controller.h"
#include "arfm_vo/driving/goal_limits.h"
#include "arfm_vo/driving/motion_watch.h"
#include "arfm_vo/driving/operator_watch.h"
#include "arfm_vo/driving/pose_watch.h"
#include "arfm_vo/driving/slip_estimator.h"
#include "arfm_vo/driving/speed_limiter.h"
#include "arfm_vo/driving/start_check.h"
#include "arfm_vo/driving/stop_look_go.h"
#include "arfm_vo/driving/track_kinematics.h"

namespace arfm_vo {

struct PilotOptions {
  TrackKinematicsOptions kinematics;
  SpeedLimiterOptions limits;
  GoalControllerOptions goal;
  StopLookGoOptions stop_look_go;
  SlipOptions slip;
  PoseWatchOptions pose;
  ChassisWatchOptions chassis;
  MotionWatchOptions motion;
  OperatorWatchOptions operator_watch;
  GoalLimitsOptions goal_limits;
  double settle_s = 0.5;             ///< from the last motion command to rest
  double resume_after_s = 1.0;       ///< the pose must be good so long before a pause ends
  double max_pause_s = 3;            ///< after a longer pause a new start is needed
  double fresh_command_s = 2;        ///< a motion that begins later is warned of first
  double warning_s = 2;              ///< lamp and horn before such a motion
  double max_tick_gap_s = 0.5;       ///< a pilot that was held up for longer needs a new start
  double arming_timeout_s = 2.0;     ///< for the chassis to take commands after start
  double max_stall_s = 20;           ///< driving time in which a goal must come nearer
  double velocity_timeout_s = 0.15;  ///< a velocity command counts no longer than this
  bool velocity_needs_pose = true;   ///< cmd_vel drives with a good pose only
  /// Items of the start-up check (docs/rover.md) that need not be well.
  std::vector<std::string> overridden_checks;

  void Check() const;
  bool IsOverridden(const std::string& item) const {
    return std::count(overridden_checks.begin(), overridden_checks.end(), item) > 0;
  }
  ARFM_FIELDS(kinematics, limits, goal, stop_look_go, slip, pose, chassis, motion, operator_watch,
              goal_limits, settle_s, resume_after_s, max_pause_s, fresh_command_s, warning_s,
              max_tick_gap_s, arming_timeout_s, max_stall_s, velocity_timeout_s,
              velocity_needs_pose, overridden_checks)
};

}  // namespace arfm_vo
