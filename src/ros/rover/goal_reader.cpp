#include "arfm_vo/ros/rover/goal_reader.h"

#include <tf2/exceptions.h>

#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/pose_message.h"

namespace arfm_vo {

void GoalReader::RequireFresh(const std_msgs::Header& header, const ros::Time& now) const {
  constexpr double kMaxFromFuture_s = 1;
  Require(!header.stamp.isZero(), "goal refused: it has no stamp");
  const double age_s = now.toSec() - header.stamp.toSec();
  Require(age_s >= -kMaxFromFuture_s, "goal refused: its stamp is in the future");
  Require(age_s <= max_age_s_, "goal refused: it is " + std::to_string(std::lround(age_s)) +
                                   " s old, older than " + std::to_string(max_age_s_) + " s");
}

Waypoint GoalReader::Read(const geometry_msgs::PoseStamped& goal) const {
  const std::string& frame = goal.header.frame_id;
  Require(!frame.empty(), "goal refused: it has no frame_id");
  Rigid3 map_from_goal = ToRigid3(goal.pose);
  const std::string flaw = FindGoalFlaw(map_from_goal);
  Require(flaw.empty(), "goal refused: " + flaw);
  map_from_goal.rotation.normalize();
  if (frame != map_frame_) {
    try {
      const auto transform = buffer_.lookupTransform(map_frame_, frame, ros::Time(0)).transform;
      map_from_goal = FromMessage(transform, "tf from " + frame) * map_from_goal;
    } catch (const tf2::TransformException& error) {
      Require(false, "goal refused: frame '" + frame + "': " + error.what());
    }
    const std::string flaw_in_map = FindGoalFlaw(map_from_goal);
    Require(flaw_in_map.empty(), "goal refused: in " + map_frame_ + " " + flaw_in_map);
  }
  return ToWaypoint(map_from_goal);
}

Route GoalReader::Read(const nav_msgs::Path& path) const {
  Require(!path.poses.empty(), "path refused: it has no poses");
  Route route;
  for (geometry_msgs::PoseStamped pose : path.poses) {
    if (pose.header.frame_id.empty()) pose.header.frame_id = path.header.frame_id;
    try {
      route.push_back(Read(pose));
    } catch (const std::invalid_argument& error) {
      Require(false, "pose " + std::to_string(route.size()) + " of the path: " + error.what());
    }
  }
  return route;
}

PlanarMotion ReadVelocity(const geometry_msgs::Twist& twist) {
  const PlanarMotion motion{twist.linear.x, twist.angular.z};
  Require(motion.IsFinite(), "velocity refused: it is not finite");
  const bool is_planar =
      twist.linear.y == 0 && twist.linear.z == 0 && twist.angular.x == 0 && twist.angular.y == 0;
  Require(is_planar, "velocity refused: a tracked rover moves along x and turns about z only");
  return motion;
}

}  // namespace arfm_vo
