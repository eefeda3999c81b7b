#include "arfm_vo/odometry/motion_model.h"

#include <algorithm>

#include "arfm_vo/geometry/screw_motion.h"

namespace arfm_vo {

void MotionModel::Add(double stamp_s, const Rigid3& body_from_world) {
  if (KnowsSpeed() && stamp_s > last_->stamp_s) Learn(stamp_s, body_from_world);
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

void MotionModel::Learn(double stamp_s, const Rigid3& body_from_world) {
  constexpr double kRemembered = 0.7, kMost = 9;  // one jerk does not make it usual
  const Rigid3 between = body_from_world * Predict(stamp_s)->Inverse();
  const double squared_s2 = std::pow(ChangeTime(stamp_s), 2);
  const auto take = [&](double squared, double& usual) {
    usual = kRemembered * usual + (1 - kRemembered) * std::min(squared / squared_s2, kMost * usual);
  };
  take(between.translation.squaredNorm(), squared_m_);
  take(between.Angle() * between.Angle(), squared_rad_);
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
