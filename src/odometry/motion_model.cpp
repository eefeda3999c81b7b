#include "arfm_vo/odometry/motion_model.h"

#include "arfm_vo/geometry/screw_motion.h"

namespace arfm_vo {

void MotionModel::Add(double stamp_s, const Rigid3& body_from_world) {
  Motion now{stamp_s, body_from_world, std::nullopt, 0, stamp_s};
  if (last_ && stamp_s > last_->stamp_s) {
    if (is_new_world_) {
      now.body_from_before = last_->body_from_before;
      now.interval_s = last_->interval_s;
      now.speed_stamp_s = last_->speed_stamp_s;
    } else {
      now.body_from_before = body_from_world * last_->body_from_world.Inverse();
      now.interval_s = stamp_s - last_->stamp_s;
    }
  }
  last_ = now;
  is_new_world_ = false;
}

double MotionModel::ChangeTime(double stamp_s) const {
  return (stamp_s - last_->speed_stamp_s) * (stamp_s - last_->stamp_s);
}

std::optional<Rigid3> MotionModel::Predict(double stamp_s) const {
  if (!last_ || is_new_world_) return std::nullopt;
  if (!last_->body_from_before || last_->interval_s <= 0) return last_->body_from_world;
  const double ratio = (stamp_s - last_->stamp_s) / last_->interval_s;
  return ScrewMotion(*last_->body_from_before, ratio) * last_->body_from_world;
}

}  // namespace arfm_vo
