#pragma once

#include <nodelet/nodelet.h>
#include <ros/ros.h>

#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include "arfm_vo/base/process_usage.h"
#include "arfm_vo/configuration/yaml_writer.h"

namespace arfm_vo {

/// The main of a node: constructs Node(public, private node handle) and spins, or what else `run`
/// does. Wrong use and configuration end it with a clear error and exit status 1. Where the
/// arguments ask for it (--help, -h), prints what the node does, which is `text`, and its
/// parameters with their defaults, without a master.
template <class Node, class Options>
int RunNode(
    int argc, char** argv, const char* name, const char* text,
    void (*run)(Node&) = [](Node&) { ros::spin(); }) {
  for (int i = 1; i < argc; ++i) {
    if (argv[i] != std::string("--help") && argv[i] != std::string("-h")) continue;
    std::cout << "usage: rosrun arfm_vo " << name << " [_PARAMETER:=VALUE ..] [TOPIC:=OTHER ..]\n\n"
              << text << "\n\nprivate parameters and their defaults, as YAML:\n\n"
              << WriteYaml(Options());
    return 0;
  }
  KeepMemoryFlat();
  ros::init(argc, argv, name);
  const ros::NodeHandle keeper;  // the last handle that goes takes the log with it
  try {
    Node node{ros::NodeHandle(), ros::NodeHandle("~")};
    run(node);
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
