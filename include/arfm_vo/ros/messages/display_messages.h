#pragma once

#include <arfm_vo/MapStatus.h>
#include <nav_msgs/Path.h>
#include <sensor_msgs/PointCloud2.h>
#include <visualization_msgs/Marker.h>

#include <vector>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "arfm_vo/odometry/placed_map.h"

namespace arfm_vo {

/// A path for display that reaches from the start to the end and yet stays small: poses keep a
/// distance, and a full path gives away every second pose.
class BoundedPath {
 public:
  /// `spacing_m` at first, doubled whenever the path is full; 2000 poses make 200 kB of message.
  explicit BoundedPath(double spacing_m = 0.05, size_t max_poses = 2000)
      : first_spacing_m_(spacing_m), max_poses_(max_poses), spacing_m_(spacing_m) {}

  /// Takes the newest pose; true where it went into the path.
  bool Add(const std_msgs::Header& header, const geometry_msgs::Pose& pose);
  void Clear();

  const nav_msgs::Path& path() const { return path_; }

 private:
  const double first_spacing_m_;
  const size_t max_poses_;
  double spacing_m_;
  nav_msgs::Path path_;
};

/// A cloud with the fields x, y, z, rgb (blue near, red far) and depth; header is the caller's.
sensor_msgs::PointCloud2 MakeLandmarkCloud(const std::vector<LandmarkPoint>& points);

/// The state above the rover, at any time.
visualization_msgs::Marker MakeMapText(const MapStatus& status, const Rigid3& map_from_base);

}  // namespace arfm_vo
