#include "arfm_vo/driving/pilot_options.h"

#include "arfm_vo/base/range_check.h"

namespace arfm_vo {

void PilotOptions::Check() const {
  goal.Check();
  RequireInRange(settle_s, 0, 60, "settle_s");
  RequireInRange(resume_after_s, 0, 60, "resume_after_s");
  RequireInRange(max_pause_s, 0, 60, "max_pause_s");
  RequireInRange(fresh_command_s, 0, 10, "fresh_command_s");
  RequireInRange(warning_s, 0, 60, "warning_s");
  RequireInRange(max_tick_gap_s, 0.1, 60, "max_tick_gap_s");
  RequireInRange(arming_timeout_s, 0.2, 60, "arming_timeout_s");
  RequireInRange(max_stall_s, 1, 1e9, "max_stall_s");
  Require(velocity_timeout_s >= 0.05 && velocity_timeout_s <= 0.18,
          "velocity_timeout_s must be in 0.05..0.18: the rover must stand within 0.2 s");
  for (const std::string& item : overridden_checks)
    Require(std::count(std::begin(kCheckItems), std::end(kCheckItems), item) > 0,
            "overridden_checks: there is no check '" + item + "'");
}

}  // namespace arfm_vo
