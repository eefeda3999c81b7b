#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <Eigen/Core>
#include <vector>

namespace arfm_vo {

/// A landmark for display.
struct LandmarkPoint {
  Eigen::Vector3d x_in_map;
  float depth_m = 0;  ///< from the camera that saw it first
};

/// A cloud with the fields x, y, z, rgb (blue near, red far) and depth; header is the caller's.
sensor_msgs::PointCloud2 MakeLandmarkCloud(const std::vector<LandmarkPoint>& points);

}  // namespace arfm_vo
