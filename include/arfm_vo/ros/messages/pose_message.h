#pragma once

#include <geometry_msgs/Pose.h>

#include <boost/array.hpp>

#include "arfm_vo/geometry/rigid3.h"

namespace arfm_vo {

/// The pose as the message has it: whether it is finite and its quaternion of unit length is not
/// checked.
inline Rigid3 ToRigid3(const geometry_msgs::Pose& pose) {
  return {Eigen::Quaterniond(pose.orientation.w, pose.orientation.x, pose.orientation.y,
                             pose.orientation.z),
          Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z)};
}

/// A pose's or twist's covariance row by row.
inline boost::array<double, 36> ToCovarianceMessage(const Eigen::Matrix<double, 6, 6>& covariance) {
  boost::array<double, 36> message;
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(message.data()) = covariance;
  return message;
}

}  // namespace arfm_vo
