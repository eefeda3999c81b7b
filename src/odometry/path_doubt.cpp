#include "arfm_vo/odometry/path_doubt.h"

#include <algorithm>

namespace arfm_vo {
namespace {

/// How far from its motion before a base may be: this part of the way, and this much.
constexpr double kOtherWay = 0.5, kOtherWay_m = 0.02;
/// The base goes on as before if it has done so on this way, or for so long where it stands.
constexpr double kKnownBy_m = 0.1, kKnownBy_s = 1;

}  // namespace

void PathDoubt::Advance(double interval_s) {
  const bool was_likely = IsLikely();
  const double before = Probability();
  ground_.Advance(interval_s, kAnotherComes_s, kAnotherLeaves_s);
  if (was_likely) closed_ += (IsLikely() ? before - Probability() : before) * Squared();
}

void PathDoubt::Follow(double stamp_s, const Rigid3& pose, const std::optional<Rigid3>& predicted,
                       double log_odds) {
  if (last_) Advance(std::max(0., stamp_s - last_->stamp_s));
  if (!IsLikely() || !before_.KnowsSpeed()) {
    before_.Reset();
    if (predicted && last_ && stamp_s > last_->stamp_s) {
      before_.Add(last_->stamp_s, last_->camera_from_world);
      before_.Add(stamp_s, *predicted);
    }
  }
  ground_.Limit(log_odds);
  last_ = StampedPose{stamp_s, pose};
  displacement_.setZero();
  if (const auto as_before = before_.Predict(stamp_s)) {
    displacement_ = as_before->Inverse().translation - pose.Inverse().translation;
  }
}

NewMapDoubt::NewMapDoubt(double stamp_s, const Rigid3& odom_from_base, const Twist& twist_before)
    : stamp_s_(stamp_s), odom_from_start_(odom_from_base), twist_before_(twist_before) {}

bool NewMapDoubt::Follow(double stamp_s, const Rigid3& odom_from_base) {
  const double time_s = stamp_s - stamp_s_;
  const Eigen::Vector3d expected = time_s * twist_before_.head<3>();
  const Rigid3 start_from_base = odom_from_start_.Inverse() * odom_from_base;
  const double way_m = expected.norm(), other_m = (start_from_base.translation - expected).norm();
  const bool is_other = other_m > kOtherWay * way_m + kOtherWay_m;
  is_over_ = is_other ? time_s >= kAnotherLeaves_s : way_m >= kKnownBy_m || time_s >= kKnownBy_s;
  return is_other;
}

}  // namespace arfm_vo
