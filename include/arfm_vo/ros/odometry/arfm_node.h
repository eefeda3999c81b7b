#pragma once

#include <ros/node_handle.h>

#include <memory>

namespace arfm_vo {

/// Rectified stereo pairs in, `features` out: layers image to reconstruction. Subscribes to the
/// pairs only while somebody subscribes to `features`, so that a player which waits for subscribers
/// waits for the whole chain.
class ArfmNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter (ArfmNodeOptions).
  ArfmNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Tells how many pairs came on the console.
  ~ArfmNode();

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace arfm_vo
