#include "arfm_vo/driving/pilot_options.h"

namespace arfm_vo {

void PilotOptions::Check() const {
  kinematics.Check();
  limits.Check();
  goal.Check();
  stop_look_go.Check();
  slip.Check();
  pose.Check();
  chassis.Check();
  motion.Check();
  operator_watch.Check();
  goal_limits.Check();
  Require(settle_s >= 0 && settle_s <= 60, "settle_s must be in 0..60");
  Require(resume_after_s >= 0 && resume_after_s <= 60, "resume_after_s must be in 0..60");
  Require(max_pause_s >= 0 && max_pause_s <= 60, "max_pause_s must be in 0..60");
  Require(fresh_command_s >= 0 && fresh_command_s <= 10, "fresh_command_s must be in 0..10");
  Require(warning_s >= 0 && warning_s <= 60, "warning_s must be in 0..60");
  Require(max_tick_gap_s >= 0.1 && max_tick_gap_s <= 60, "max_tick_gap_s must be in 0.1..60");
  Require(arming_timeout_s >= 0.2 && arming_timeout_s <= 60, "arming_timeout_s must be in 0.2..60");
  Require(max_stall_s >= 1 && max_stall_s <= 1e9, "max_stall_s must be in 1..1e9");
  Require(velocity_timeout_s >= 0.05 && velocity_timeout_s <= 0.18,
          "velocity_timeout_s must be in 0.05..0.18: the rover must stand within 0.2 s");
  for (const std::string& item : overridden_checks)
    Require(std::count(std::begin(kCheckItems), std::end(kCheckItems), item) > 0,
            "overridden_checks: there is no check '" + item + "'");
}

}  // namespace arfm_vo
