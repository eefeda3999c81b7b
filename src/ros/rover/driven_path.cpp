#include "arfm_vo/ros/rover/driven_path.h"

#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/driving/way_home.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {
namespace {

RoverPose ToRoverPose(const geometry_msgs::Pose& pose) {
  return ProjectToPlane(ReadPose(pose, "path_optimized: "));
}

}  // namespace

DrivenPath::DrivenPath(ros::NodeHandle& node)
    : paths_(node.subscribe<nav_msgs::Path>("path_optimized", 1,
                                            [this](const auto& path) { path_ = path; })),
      statuses_(node.subscribe<MapStatus>("map_status", 1,
                                          [this](const auto& status) { status_ = status; })) {}

Route DrivenPath::PlanHome(const geometry_msgs::PoseStamped& base) const {
  const std::string& map_frame = base.header.frame_id;
  Require(!map_frame.empty(), "way home: the rover has no pose");
  Require(path_ != nullptr, "way home: ba_node tells no path_optimized");
  Require(path_->header.frame_id == map_frame,
          "way home: path_optimized is in '" + path_->header.frame_id + "', not in " + map_frame);
  Require(!status_ || status_->state != MapStatus::LOCALISING,
          "way home: the rover is still looked for in the map (map_status: LOCALISING)");
  std::vector<RoverPose> driven;
  for (const auto& place : path_->poses) driven.push_back(ToRoverPose(place.pose));
  return FindWayHome(driven, ToRoverPose(base.pose));
}

}  // namespace arfm_vo
