#pragma once

#include <ros/node_handle.h>

#include <memory>

namespace arfm_vo {

/// Keyframes in, the globally adjusted map out (Fig. 4).
class BaNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter (BaNodeOptions).
  BaNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the keyframes where a directory is set.
  ~BaNode();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arfm_vo
