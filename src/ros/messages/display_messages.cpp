#include "arfm_vo/ros/messages/display_messages.h"

#include <sensor_msgs/point_cloud2_iterator.h>

#include <cmath>

#include "arfm_vo/evaluation/match_picture.h"
#include "arfm_vo/ros/messages/conversions.h"

namespace arfm_vo {

void BoundedPath::Clear() {
  path_.poses.clear();
  spacing_m_ = first_spacing_m_;
}

bool BoundedPath::Add(const std_msgs::Header& header, const geometry_msgs::Pose& pose) {
  std::vector<geometry_msgs::PoseStamped>& poses = path_.poses;
  if (!poses.empty()) {
    const geometry_msgs::Point &last = poses.back().pose.position, &next = pose.position;
    if (std::hypot(next.x - last.x, next.y - last.y, next.z - last.z) < spacing_m_) return false;
  }
  if (poses.size() >= max_poses_) {
    size_t kept = 0;
    for (size_t i = 0; i < poses.size(); i += 2) poses[kept++] = poses[i];
    poses.resize(kept);
    spacing_m_ *= 2;
  }
  path_.header = header;
  poses.emplace_back();
  poses.back().header = header;
  poses.back().pose = pose;
  return true;
}

sensor_msgs::PointCloud2 MakeLandmarkCloud(const std::vector<LandmarkPoint>& points) {
  sensor_msgs::PointCloud2 cloud;
  sensor_msgs::PointCloud2Modifier modifier(cloud);
  modifier.setPointCloud2Fields(
      5, "x", 1, sensor_msgs::PointField::FLOAT32, "y", 1, sensor_msgs::PointField::FLOAT32, "z", 1,
      sensor_msgs::PointField::FLOAT32, "rgb", 1, sensor_msgs::PointField::FLOAT32, "depth", 1,
      sensor_msgs::PointField::FLOAT32);
  modifier.resize(points.size());
  cloud.is_dense = true;
  if (points.empty()) return cloud;  // the iterators take the first byte's address

  std::vector<float> depths_m;
  for (const LandmarkPoint& point : points) depths_m.push_back(point.depth_m);
  const DepthColors colors(depths_m);
  sensor_msgs::PointCloud2Iterator<float> x(cloud, "x"), depth(cloud, "depth");
  sensor_msgs::PointCloud2Iterator<uint8_t> bgr(cloud, "rgb");
  for (const LandmarkPoint& point : points) {
    const cv::Scalar color = colors.BgrOf(point.depth_m);
    for (int i = 0; i < 3; ++i) {
      x[i] = static_cast<float>(point.x_in_map[i]);
      bgr[i] = static_cast<uint8_t>(color[i]);
    }
    *depth = point.depth_m;
    ++x, ++bgr, ++depth;
  }
  return cloud;
}

visualization_msgs::Marker MakeMapText(const MapStatus& status, const Rigid3& map_from_base) {
  visualization_msgs::Marker text;
  text.header.frame_id = status.header.frame_id;
  text.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
  text.pose = ToPoseMessage(map_from_base);
  text.pose.position.z += 2;
  text.scale.z = 0.5;
  text.color.r = text.color.g = text.color.b = text.color.a = 1;
  text.text = status.state_text;
  return text;
}

}  // namespace arfm_vo
