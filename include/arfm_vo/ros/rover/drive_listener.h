#pragma once

#include <arfm_vo/DriveStatus.h>
#include <ros/ros.h>

namespace arfm_vo {

/// Whether the rover drives, by the `drive_status` that chassis_node publishes 5 times a second.
class DriveListener {
 public:
  explicit DriveListener(ros::NodeHandle node)
      : status_(node.subscribe("drive_status", 1, &DriveListener::Take, this)) {}

  /// Drives, will soon, or pauses and goes on by itself. A status that is no longer told says
  /// nothing.
  bool IsDriving() const {
    return is_driving_ && ros::SteadyTime::now() - taken_ < ros::WallDuration(kMaxAge_s);
  }

 private:
  static constexpr double kMaxAge_s = 2;

  void Take(const DriveStatus& status) {
    is_driving_ = status.state == DriveStatus::DRIVING || status.state == DriveStatus::WARNING ||
                  status.state == DriveStatus::PAUSED;
    taken_ = ros::SteadyTime::now();
  }

  bool is_driving_ = false;
  ros::SteadyTime taken_;
  ros::Subscriber status_;
};

}  // namespace arfm_vo
