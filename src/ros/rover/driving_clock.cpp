#include "arfm_vo/ros/rover/driving_clock.h"

#include <algorithm>

namespace arfm_vo {

double DrivingClock::Now() {
  if (!ros::Time::isSimTime()) return ros::SteadyTime::now().toSec();
  const ros::Time now = ros::Time::now();
  if (!last_.isZero()) simulated_s_ += std::max(0.0, now.toSec() - last_.toSec());
  last_ = now;
  return simulated_s_;
}

}  // namespace arfm_vo
