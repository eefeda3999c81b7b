#pragma once

#include <ros/names.h>
#include <ros/ros.h>

namespace arfm_vo {

/// Where time is simulated, waits for the first of it: by a clock that stands at zero every stamp
/// of others is from the future, and what was measured before now has no stamp.
inline void WaitForClock() {
  while (ros::ok() && !ros::Time::waitForValid(ros::WallDuration(5))) {
    ROS_WARN("use_sim_time is set, and nothing comes on %s: waiting for it",
             ros::names::resolve("/clock").c_str());
  }
}

}  // namespace arfm_vo
