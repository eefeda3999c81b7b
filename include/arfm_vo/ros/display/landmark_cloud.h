#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <vector>

#include "arfm_vo/odometry/placed_map.h"

namespace arfm_vo {

/// A cloud with the fields x, y, z, rgb (blue near, red far) and depth; header is the caller's.
sensor_msgs::PointCloud2 MakeLandmarkCloud(const std::vector<LandmarkPoint>& points);

}  // namespace arfm_vo
