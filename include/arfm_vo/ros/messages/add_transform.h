#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <ros/time.h>
#include <tf2/buffer_core.h>

#include <string>

namespace arfm_vo {

/// Puts a transform that `source` has published into `buffer`. Returns false where its stamp is too
/// far ahead of `now`: it would hold back all later ones, and the largest stamp makes tf2 throw. A
/// static one holds at all times, whatever its stamp.
bool AddTransform(geometry_msgs::TransformStamped transform, bool is_static, const ros::Time& now,
                  const std::string& source, tf2::BufferCore& buffer);

}  // namespace arfm_vo
