#pragma once

#include <nav_msgs/Odometry.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <optional>
#include <string>

#include "arfm_vo/driving/pose_watch.h"

namespace arfm_vo {

/// Where the rover stands by sight, as tf tells it.
struct Sighting {
  ros::Time stamp;  ///< of the newest odom -> base
  Rigid3 odom_from_base;
  Rigid3 map_from_odom;
  ros::Time map_stamp;  ///< of the newest map -> odom; zero where it is static

  /// How long before `now` map -> odom was told, s; 0 where it is static.
  double MapAge(const ros::Time& now) const {
    return map_stamp.isZero() ? 0 : now.toSec() - map_stamp.toSec();
  }
};

/// Looks the rover's pose up in tf. The age of a sighting is that of odom -> base alone; that of
/// map -> odom says whether the node that tells it still runs.
class RoverSight {
 public:
  /// `buffer` must outlive this object.
  RoverSight(const tf2::BufferCore& buffer, std::string map_frame, std::string odom_frame,
             std::string base_frame);

  /// The newest pose; nothing where tf has none.
  std::optional<Sighting> Look() const;

 private:
  const tf2::BufferCore& buffer_;
  std::string map_frame_, odom_frame_, base_frame_;
};

/// The standard deviations that the covariance of `odometry` means, taken at driving time
/// `taken_s`; NaN where it is no covariance.
PoseUncertainty ToUncertainty(const nav_msgs::Odometry& odometry, double taken_s);

}  // namespace arfm_vo
