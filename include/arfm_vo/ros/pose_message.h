#pragma once

#include <geometry_msgs/Pose.h>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// The pose as the message has it: whether it is finite and its quaternion of unit length is not
/// checked.
inline Rigid3 ToRigid3(const geometry_msgs::Pose& pose) {
  return {Eigen::Quaterniond(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                             pose.orientation.z),
          Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z)};
}

}  // namespace arfm_vo
