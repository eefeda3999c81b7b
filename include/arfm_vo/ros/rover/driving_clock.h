#pragma once

#include <ros/time.h>

namespace arfm_vo {

/// The time of driving, seconds that never jump: of the machine's steady clock, or, where ROS time
/// comes from /clock, of that clock without its leaps back.
class DrivingClock {
 public:
  double Now();
  /// The driving time at which ROS time was `stamp`, by the clocks of now; for any stamp.
  double At(const ros::Time& stamp) { return Now() - (ros::Time::now().toSec() - stamp.toSec()); }

 private:
  ros::Time last_;
  double simulated_s_ = 0;
};

}  // namespace arfm_vo
