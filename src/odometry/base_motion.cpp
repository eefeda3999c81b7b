#include "arfm_vo/odometry/base_motion.h"

namespace arfm_vo {

const Rigid3& BaseMotion::Move(const Rigid3& camera_from_world, const Rigid3& base_from_camera) {
  if (!has_world_) odom_from_world_ = odom_from_base_ * base_from_camera * camera_from_world;
  has_world_ = true;
  odom_from_base_ = odom_from_world_ * camera_from_world.Inverse() * base_from_camera.Inverse();
  return odom_from_base_;
}

}  // namespace arfm_vo
