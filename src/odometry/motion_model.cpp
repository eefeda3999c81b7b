#include "arfm_vo/odometry/motion_model.h"

namespace arfm_vo {

void MotionModel::Add(double stamp_s, const Rigid3& camera_from_world) {
  Motion now{stamp_s, camera_from_world, std::nullopt, 0};
  if (last_) {
    now.camera_from_before = camera_from_world * last_->camera_from_world.Inverse();
    now.interval_s = stamp_s - last_->stamp_s;
  }
  last_ = now;
}

std::optional<Rigid3> MotionModel::Predict(double stamp_s) const {
  if (!last_) return std::nullopt;
  if (!last_->camera_from_before || last_->interval_s <= 0) return last_->camera_from_world;
  const double ratio = (stamp_s - last_->stamp_s) / last_->interval_s;
  const Rigid3 motion(ExpSO3(ratio * LogSO3(last_->camera_from_before->rotation)),
                      Eigen::Vector3d(ratio * last_->camera_from_before->translation));
  return motion * last_->camera_from_world;
}

}  // namespace arfm_vo
