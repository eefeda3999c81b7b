#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <string>
#include <vector>

#include "arfm_vo/odometry/placed_map.h"

namespace arfm_vo {

/// What ba_node publishes of the map: map_update, path_optimized, landmarks.
class MapOutputs {
 public:
  /// Paths of more than `max_path_poses` are thinned out.
  MapOutputs(ros::NodeHandle node, std::string map_frame, int max_path_poses);

  void PublishUpdate(const MapUpdate& update, uint32_t epoch, const ros::Time& stamp);
  void Publish(const std::vector<MapPose>& poses, const std::vector<LandmarkPoint>& points,
               const ros::Time& stamp);

 private:
  std_msgs::Header MakeHeader(const ros::Time& stamp) const;

  std::string map_frame_;
  int max_path_poses_;
  ros::Publisher updates_, path_, landmarks_;
};

}  // namespace arfm_vo
