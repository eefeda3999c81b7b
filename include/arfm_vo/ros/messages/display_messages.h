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

struct BoundedPathOptions {
  double spacing_m = 0.05;  ///< at first; doubled whenever the path is full
  int max_poses = 2000;     ///< keeps a message below 200 kB

  void Check() const {
    Require(spacing_m >= 0, "path.spacing_m must not be negative");
    Require(max_poses >= 2, "path.max_poses must be at least 2");
  }
  ARFM_FIELDS(spacing_m, max_poses)
};

/// A path for display that reaches from the start to the end and yet stays small: poses keep a
/// distance, and a full path gives away every second pose.
class BoundedPath {
 public:
  explicit BoundedPath(const BoundedPathOptions& options) : options_(options) { Clear(); }

  /// Takes the newest pose; true where it went into the path.
  bool Add(const std_msgs::Header& header, const geometry_msgs::Pose& pose);
  void Clear();

  const nav_msgs::Path& path() const { return path_; }

 private:
  BoundedPathOptions options_;
  double spacing_m_ = 0;
  nav_msgs::Path path_;
};

/// A cloud with the fields x, y, z, rgb (blue near, red far) and depth; header is the caller's.
sensor_msgs::PointCloud2 MakeLandmarkCloud(const std::vector<LandmarkPoint>& points);

/// The state above the rover, at any time.
visualization_msgs::Marker MakeMapText(const MapStatus& status, const Rigid3& map_from_base);

}  // namespace arfm_vo
