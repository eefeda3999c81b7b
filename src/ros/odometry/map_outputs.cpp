#include "arfm_vo/ros/odometry/map_outputs.h"

#include <nav_msgs/Path.h>

#include <boost/make_shared.hpp>
#include <utility>

#include "arfm_vo/ros/display/landmark_cloud.h"
#include "arfm_vo/ros/messages/conversions.h"
#include "arfm_vo/ros/messages/pose_message.h"

namespace arfm_vo {

MapOutputs::MapOutputs(ros::NodeHandle node, std::string map_frame, int max_path_poses)
    : map_frame_(std::move(map_frame)),
      max_path_poses_(max_path_poses),
      updates_(node.advertise<MapUpdateStamped>("map_update", 2)),
      path_(node.advertise<nav_msgs::Path>("path_optimized", 1, true)),
      landmarks_(node.advertise<sensor_msgs::PointCloud2>("landmarks", 1, true)) {}

std_msgs::Header MapOutputs::MakeHeader(const ros::Time& stamp) const {
  std_msgs::Header header;
  header.stamp = stamp;
  header.frame_id = map_frame_;
  return header;
}

void MapOutputs::PublishUpdate(const MapUpdate& update, uint32_t epoch, const ros::Time& stamp) {
  const auto message = boost::make_shared<MapUpdateStamped>(ToMessage(update));
  message->header = MakeHeader(stamp);
  message->epoch = epoch;
  updates_.publish(message);
}

void MapOutputs::Publish(const std::vector<MapPose>& poses,
                         const std::vector<LandmarkPoint>& points, const ros::Time& stamp) {
  const size_t stride = 1 + poses.size() / max_path_poses_;
  nav_msgs::Path path;
  path.header = MakeHeader(stamp);
  for (size_t i = (poses.size() - 1) % stride; i < poses.size(); i += stride) {
    path.poses.emplace_back();
    path.poses.back().header.frame_id = map_frame_;
    path.poses.back().header.stamp.fromSec(poses[i].stamp_s);
    path.poses.back().pose = ToPoseMessage(poses[i].map_from_base);
  }
  path_.publish(path);
  sensor_msgs::PointCloud2 cloud = MakeLandmarkCloud(points);
  cloud.header = path.header;
  landmarks_.publish(cloud);
}

}  // namespace arfm_vo
