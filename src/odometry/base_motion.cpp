#include "arfm_vo/odometry/base_motion.h"

#include <algorithm>
#include <cmath>

namespace arfm_vo {

const Rigid3& BaseMotion::Move(const Rigid3& camera_from_world, const Rigid3& base_from_camera) {
  if (!has_world_) odom_from_world_ = odom_from_base_ * base_from_camera * camera_from_world;
  has_world_ = true;
  odom_from_base_ = odom_from_world_ * camera_from_world.Inverse() * base_from_camera.Inverse();
  return odom_from_base_;
}

void BaseMotion::Level(const std::optional<Eigen::Vector3d>& up_in_world, double max_rad) {
  if (!up_in_world) return;
  const Eigen::Vector3d up = odom_from_world_.rotation * *up_in_world;
  const Eigen::Vector3d axis = up.cross(Eigen::Vector3d::UnitZ());
  const double angle_rad = std::min(std::atan2(axis.norm(), up.z()), max_rad);
  const Rigid3 turn(ExpSO3(angle_rad * axis.normalized()), Eigen::Vector3d::Zero());
  const Rigid3 to_base(Eigen::Quaterniond::Identity(), -odom_from_base_.translation);
  const Rigid3 levelled_from_odom = to_base.Inverse() * turn * to_base;
  odom_from_world_ = levelled_from_odom * odom_from_world_;
  odom_from_base_ = levelled_from_odom * odom_from_base_;
}

void BaseMotion::StandBy(const std::optional<Eigen::Vector3d>& up_in_base) {
  if (!up_in_base) return;
  const Eigen::Vector3d& up = *up_in_base;
  const Eigen::Vector3d left = up.cross(Eigen::Vector3d::UnitX()).normalized();
  Eigen::Matrix3d odom_from_base;
  odom_from_base << left.cross(up).transpose(), left.transpose(), up.transpose();
  odom_from_base_ = Rigid3(odom_from_base, Eigen::Vector3d::Zero());
}

}  // namespace arfm_vo
