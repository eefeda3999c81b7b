#pragma once

#include <arfm_vo/OdometryStatus.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/Twist.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <ros/message_event.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "arfm_vo/driving/picture_watch.h"
#include "arfm_vo/driving/planar_motion.h"
#include "arfm_vo/driving/pose_watch.h"
#include "arfm_vo/driving/route.h"
#include "arfm_vo/hardware/clock_offset.h"

namespace arfm_vo {

// What chassis_node makes of the messages, of tf and of the clock, for the pilot.

/// Turns goals in any tf frame into waypoints of the map. What can be no goal throws
/// std::invalid_argument with the reason: a frame that is missing or unknown, a value that is not
/// finite, a quaternion that is not of unit length, a path without poses.
struct GoalReader {
  const tf2::BufferCore& buffer;  ///< must outlive the reader
  std::string map_frame;
  double max_age_s;  ///< goals that are older are refused

  /// Throws std::invalid_argument where a goal of this header has no stamp, or one that is too old
  /// at `now` or from the future.
  void RequireFresh(const std_msgs::Header& header, const ros::Time& now) const;
  Waypoint Read(const geometry_msgs::PoseStamped& goal) const;
  /// A pose without frame_id is in the path's frame.
  Route Read(const nav_msgs::Path& path) const;
};

/// The velocity that a tracked rover can follow. Throws std::invalid_argument where it is not
/// finite, or asks for a motion sideways, up, or about another axis than z.
PlanarMotion ReadVelocity(const geometry_msgs::Twist& twist);

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
struct RoverSight {
  const tf2::BufferCore& buffer;  ///< must outlive this object
  std::string map_frame, odom_frame, base_frame;

  /// The newest pose; nothing where tf has none.
  std::optional<Sighting> Look() const;
  geometry_msgs::PoseStamped BaseInMap(const Sighting& sighting) const;
};

/// The standard deviations that the covariance of `odometry` means, taken at driving time
/// `taken_s`; NaN where it is no covariance.
PoseUncertainty ToUncertainty(const nav_msgs::Odometry& odometry, double taken_s);

/// What the odometry tells of the pair of the given time on the driving clock. Patches alone give a
/// TRACKED pose only where the right image shows most of them (PatchTracker::Decides).
Picture ToPicture(const OdometryStatus& status, double taken_s);

/// Numbers the epochs of the odometry, in each of which its pose is continuous. A new one begins
/// where the number in `status` changes, and where the messages come from another process.
class EpochReader {
 public:
  /// Counts from 1.
  uint32_t Read(const ros::MessageEvent<const OdometryStatus>& event);

 private:
  uint32_t epoch_ = 0, number_ = 0;
  boost::shared_ptr<ros::M_string> connection_;
};

/// The time of driving, seconds that never jump: of the machine's steady clock, or, where ROS time
/// comes from /clock, of that clock without its leaps back.
class DrivingClock {
 public:
  /// `wall` is the clock that ROS time is of where it is not simulated.
  explicit DrivingClock(ClockOffset::Clock wall = [] { return ros::WallTime::now().toSec(); })
      : offset_([] { return ros::SteadyTime::now().toSec(); }, std::move(wall), 0) {}

  double Now();
  /// By how much ROS time was set since the last call, s, forward positive; 0 where it was not. To
  /// be called each tick: a clock that is steered moves by less than 10 ms in that time. Of
  /// simulated time leaps back alone are told: what leaps ahead may run fast.
  double TakeStep();
  /// The driving time at which ROS time was `stamp`, by the clocks of now; for any stamp.
  double At(const ros::Time& stamp) { return Now() - (ros::Time::now().toSec() - stamp.toSec()); }

 private:
  ClockOffset offset_;  // of ROS time over the steady clock
  ros::Time last_;
  double simulated_s_ = 0, back_s_ = 0;
};

}  // namespace arfm_vo
