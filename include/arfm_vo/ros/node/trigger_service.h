#pragma once

#include <ros/node_handle.h>
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

}  // namespace arfm_vo
