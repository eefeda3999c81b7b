#include "arfm_vo/odometry/senses/motion_prior.h"

#include <algorithm>

namespace arfm_vo {
namespace {

/// What a vehicle, or a hand, cannot do; and how wrong the speed before may be.
constexpr double kMaxAcceleration_m_s2 = 10, kMaxTurnAcceleration_rad_s2 = 10;
constexpr double kMaxShift_m = 0.05, kMaxTurn_rad = 0.02;
/// Poses err by so much however evenly the base moves.
constexpr double kLeastShift_m = 0.005, kLeastTurn_rad = 0.001;
/// Of a base of which nothing is known, and of one that was at rest.
constexpr double kAnySpeed_m_s = 1, kSpeedFromRest_m_s = 0.1;
/// Senses are compared with the cameras over such times, in which motions exceed the poses' errors.
constexpr double kCompareOver_s = 1;
/// A motion is compared when the pose after it is there too: so late readings have come.
constexpr size_t kNumCompared = 2;

}  // namespace

void MotionPrior::Add(double stamp_s, const Rigid3& base_from_world, const Matrix6& covariance) {
  model_.Add(stamp_s, base_from_world);
  Pose now{stamp_s, base_from_world, covariance, std::nullopt};
  if (last_ && stamp_s > last_->stamp_s) {
    const Rigid3 before_from_now = last_->base_from_world * base_from_world.Inverse();
    // On a curve the way begins as much to one side of the base as it ends to the other.
    const Eigen::Vector3d turn = LogSO3(before_from_now.rotation);
    now.velocity = ExpSO3(-turn / 2) * before_from_now.translation / (stamp_s - last_->stamp_s);
  }
  last_ = now;
  if (!compared_.empty() && stamp_s < compared_.back().stamp_s + kCompareOver_s) return;
  compared_.push_back(now);
  if (compared_.size() <= kNumCompared) return;
  const Pose &from = compared_[0], &to = compared_[1];
  RelativeMotion motion;
  motion.before_from_now = from.base_from_world * to.base_from_world.Inverse();
  motion.covariance = from.covariance + to.covariance;
  motion.covariance.diagonal().head<3>().array() += kLeastShift_m * kLeastShift_m;
  motion.covariance.diagonal().tail<3>().array() += kLeastTurn_rad * kLeastTurn_rad;
  Eigen::Vector3d change_m_s = Eigen::Vector3d::Zero();
  if (from.velocity) {
    change_m_s = *to.velocity - motion.before_from_now.rotation.conjugate() * *from.velocity;
  }
  senses_.Learn(from.stamp_s, to.stamp_s, motion, change_m_s);
  up_in_world_ = senses_.up_in_base();
  if (up_in_world_) up_in_world_ = to.base_from_world.rotation.conjugate() * *up_in_world_;
  compared_.pop_front();
}

void MotionPrior::ForgetPoses() {
  senses_.gravity().Forget();
  up_in_world_.reset();
  last_.reset();
  compared_.clear();
}

std::optional<RelativeMotion> MotionPrior::SinceLast(double stamp_s) const {
  if (!last_ || stamp_s <= last_->stamp_s) return std::nullopt;
  const auto& velocity = last_->velocity;
  const double speed_sigma_m_s = velocity ? velocity->norm() + kSpeedFromRest_m_s : kAnySpeed_m_s;
  return senses_.Between(last_->stamp_s, stamp_s, velocity.value_or(Eigen::Vector3d::Zero()),
                         speed_sigma_m_s);
}

std::optional<RelativeMotion> MotionPrior::BySenses(double stamp_s, bool keeps_speed) const {
  auto motion = SinceLast(stamp_s);
  if (!motion) return std::nullopt;
  const bool is_whole =
      motion->is_way_measured ? motion->way_m <= senses_.options().max_blind_m : keeps_speed;
  return is_whole ? motion : std::nullopt;
}

std::optional<PredictedPose> MotionPrior::Predict(double stamp_s,
                                                  const Rigid3& base_from_camera) const {
  const auto motion = SinceLast(stamp_s);
  const auto base_from_world =
      motion ? motion->before_from_now.Inverse() * last_->base_from_world : model_.Predict(stamp_s);
  if (!base_from_world) return std::nullopt;
  PredictedPose predicted(base_from_camera.Inverse() * *base_from_world);
  if (KnowsSpeed()) {
    const double squared_s = model_.ChangeTime(stamp_s);
    predicted.max_shift_m = kMaxAcceleration_m_s2 * squared_s + kMaxShift_m;
    predicted.max_turn_rad = kMaxTurnAcceleration_rad_s2 * squared_s + kMaxTurn_rad;
    predicted.sigma_shift_m = model_.usual_acceleration_m_s2() * squared_s + kLeastShift_m;
    predicted.sigma_turn_rad = model_.usual_turn_acceleration_rad_s2() * squared_s + kLeastTurn_rad;
  }
  if (motion) {
    const Eigen::Matrix<double, 6, 1> variances = motion->covariance.diagonal();
    predicted.sigma_shift_m = std::sqrt(variances.head<3>().sum()) + kLeastShift_m;
    predicted.sigma_turn_rad = std::sqrt(variances.tail<3>().sum()) + kLeastTurn_rad;
  }
  return predicted;
}

}  // namespace arfm_vo
