#pragma once

#include <arfm_vo/MapStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Path.h>
#include <ros/node_handle.h>
#include <ros/subscriber.h>

#include "arfm_vo/driving/route.h"

namespace arfm_vo {

/// The path of this drive and, where it was found in their map, those before: `path_optimized` of
/// ba_node.
class DrivenPath {
 public:
  explicit DrivenPath(ros::NodeHandle& node);

  /// The way home (FindWayHome) from `base`, in its frame, the map. Throws std::invalid_argument
  /// where there is none, where the path is in another frame, and while the drive is LOCALISING:
  /// its path begins where the rover woke up.
  Route PlanHome(const geometry_msgs::PoseStamped& base) const;

 private:
  nav_msgs::PathConstPtr path_;
  MapStatusConstPtr status_;
  ros::Subscriber paths_, statuses_;
};

}  // namespace arfm_vo
