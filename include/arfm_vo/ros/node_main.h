#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <exception>
#include <memory>

#include "arfm_vo/base/process_usage.h"

namespace arfm_vo {

/// The main of a node: constructs Node(public, private node handle) and spins. Wrong use and
/// configuration end it with a clear error and exit status 1.
template <class Node>
int RunNode(int argc, char** argv, const char* name) {
  KeepMemoryFlat();
  ros::init(argc, argv, name);
  const ros::NodeHandle keeper;  // the last handle that goes takes the log with it
  try {
    Node node{ros::NodeHandle(), ros::NodeHandle("~")};
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    ROS_FATAL("%s", error.what());
    return 1;
  }
}

/// The same node class as a nodelet; one that is wrongly configured does not load.
template <class Node>
class NodeletOf : public nodelet::Nodelet {
 private:
  void onInit() override {
    try {
      node_ = std::make_unique<Node>(getNodeHandle(), getPrivateNodeHandle());
    } catch (const std::exception& error) {
      NODELET_FATAL("%s", error.what());
      throw;
    }
  }
  std::unique_ptr<Node> node_;
};

}  // namespace arfm_vo
