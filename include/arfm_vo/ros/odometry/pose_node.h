#pragma once

#include <ros/node_handle.h>

#include <memory>

namespace arfm_vo {

/// `features` and the images they are from in, the rover's pose out: layers pose to odometry.
class PoseNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter (PoseNodeOptions).
  PoseNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the trajectory where a directory is set.
  ~PoseNode();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arfm_vo
