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
  /// `buffer` must outlive the reader. Goals older than `max_age_s` are refused.
  GoalReader(const tf2::BufferCore& buffer, std::string map_frame, double max_age_s)
      : buffer_(buffer), map_frame_(std::move(map_frame)), max_age_s_(max_age_s) {}

  /// Throws std::invalid_argument where a goal of this header has no stamp, or one that is too old
  /// at `now` or from the future.
  void RequireFresh(const std_msgs::Header& header, const ros::Time& now) const;
  Waypoint Read(const geometry_msgs::PoseStamped& goal) const;
  /// A pose without frame_id is in the path's frame.
  Route Read(const nav_msgs::Path& path) const;

 private:
  const tf2::BufferCore& buffer_;
  std::string map_frame_;
  double max_age_s_;
};

/// The velocity that a tracked rover can follow. Throws std::invalid_argument where it is not
/// finite, or asks for a motion sideways, up, or about another axis than z.
PlanarMotion ReadVelocity(const geometry_msgs::Twist& twist);

}  // namespace arfm_vo
