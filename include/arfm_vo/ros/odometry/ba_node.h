#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <tf2_ros/transform_broadcaster.h>

#include "arfm_vo/ros/odometry/adjusted_map.h"

namespace arfm_vo {

/// Keyframes in, the globally adjusted map out (Fig. 4).
class BaNode {
 public:
  /// Throws std::invalid_argument naming a wrong parameter (BaNodeOptions).
  BaNode(ros::NodeHandle node, ros::NodeHandle private_node);
  /// Saves the keyframes where a directory is set.
  ~BaNode();

 private:
  void SendTransform();

  const BaNodeOptions options_;
  AdjustedMap map_;
  tf2_ros::TransformBroadcaster broadcaster_;
  diagnostic_updater::Updater diagnostics_;
  Worker worker_;
  nav_msgs::OdometryConstPtr newest_odometry_;
  ros::Subscriber keyframes_, odometry_, stated_;
  ros::ServiceServer save_;
  ros::Time sent_;  // the newest transform's stamp
  ros::WallTimer timer_;
  ros::Timer tf_timer_;
};

}  // namespace arfm_vo
