#include "arfm_vo/ros/messages/add_transform.h"

namespace arfm_vo {

bool AddTransform(geometry_msgs::TransformStamped transform, bool is_static, const ros::Time& now,
                  const std::string& source, tf2::BufferCore& buffer) {
  constexpr double kMaxFromFuture_s = 1;
  // Where the frame was told as moving before, tf2 keeps it so and does reckon with the stamp.
  if (is_static) transform.header.stamp = now;
  if (transform.header.stamp.toSec() > now.toSec() + kMaxFromFuture_s) return false;
  buffer.setTransform(transform, source, is_static);
  return true;
}

}  // namespace arfm_vo
