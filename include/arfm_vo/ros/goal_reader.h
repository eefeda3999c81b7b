#pragma once

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Path.h>
#include <tf2/buffer_core.h>

#include <string>

#include "arfm_vo/driving/planar_motion.h"
#include "arfm_vo/driving/route.h"

namespace arfm_vo {

/// Turns goals in any tf frame into waypoints of the map. What can be no goal throws
/// std::invalid_argument with the reason: a frame that is missing or unknown, a value that is not
/// finite, a quaternion that is not of unit length, a path without poses.
class GoalReader {
 public:
  /// `buffer` must outlive the reader.
  GoalReader(const tf2::BufferCore& buffer, std::string map_frame)
      : buffer_(buffer), map_frame_(std::move(map_frame)) {}

  Waypoint Read(const geometry_msgs::PoseStamped& goal) const;
  /// A pose without frame_id is in the path's frame.
  Route Read(const nav_msgs::Path& path) const;

 private:
  const tf2::BufferCore& buffer_;
  std::string map_frame_;
};

/// The velocity that a tracked rover can follow. Throws std::invalid_argument where it is not
/// finite, or asks for a motion sideways, up, or about another axis than z.
PlanarMotion ReadVelocity(const geometry_msgs::Twist& twist);

}  // namespace arfm_vo
