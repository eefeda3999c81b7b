#pragma once

#include <ros/names.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <functional>
#include <string>

namespace arfm_vo {

/// A std_srvs/Trigger service that answers with what `action` returns, or with what it throws.
inline ros::ServiceServer OfferTrigger(ros::NodeHandle& node, const std::string& name,
                                       std::function<std::string()> action) {
  using Request = std_srvs::Trigger::Request;
  using Response = std_srvs::Trigger::Response;
  return node.advertiseService(
      name, boost::function<bool(Request&, Response&)>([action](Request&, Response& response) {
        try {
          response.message = action();
          response.success = true;
        } catch (const std::exception& error) {
          response.message = error.what();
          response.success = false;
        }
        return true;
      }));
}

/// Where time is simulated, waits for the first of it: by a clock that stands at zero every stamp
/// of others is from the future, and what was measured before now has no stamp.
inline void WaitForClock() {
  while (ros::ok() && !ros::Time::waitForValid(ros::WallDuration(5))) {
    ROS_WARN("use_sim_time is set, and nothing comes on %s: waiting for it",
             ros::names::resolve("/clock").c_str());
  }
}

}  // namespace arfm_vo
