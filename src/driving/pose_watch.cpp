#include "arfm_vo/driving/pose_watch.h"

#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/driving/route.h"

namespace arfm_vo {
namespace {

constexpr double kMaxFromFuture_s = 0.2;

}  // namespace

void PoseWatchOptions::Check() const {
  Require(max_pose_age_s > 0 && max_pose_age_s <= 3600, "pose.max_pose_age_s must be in (0, 3600]");
  Require(max_position_sigma_m > 0, "pose.max_position_sigma_m must be positive");
  Require(max_heading_sigma_rad > 0, "pose.max_heading_sigma_rad must be positive");
}

void PoseWatch::Observe(double now_s, const PoseObservation& pose) {
  const bool is_flawed = !FindGoalFlaw(pose.map_from_base).empty() ||
                         !std::isfinite(pose.taken_s) || pose.taken_s > now_s + kMaxFromFuture_s;
  flaw_ = is_flawed ? std::optional(StopReason::kPoseInvalid) : std::nullopt;
  if (!is_flawed) pose_ = pose;
}

bool PoseWatch::IsUncertain(double now_s) const {
  if (!uncertainty_) return options_.requires_covariance;
  if (options_.requires_covariance && !(now_s - uncertainty_->taken_s <= options_.max_pose_age_s))
    return true;
  // Written so that NaN is uncertain.
  return !(uncertainty_->position_sigma_m <= options_.max_position_sigma_m &&
           uncertainty_->heading_sigma_rad <= options_.max_heading_sigma_rad);
}

std::optional<StopReason> PoseWatch::FindFault(double now_s) const {
  if (flaw_) return flaw_;
  if (now_s - pose_->taken_s > options_.max_pose_age_s) return StopReason::kPoseStale;
  if (IsUncertain(now_s)) return StopReason::kPoseUncertain;
  return std::nullopt;
}

}  // namespace arfm_vo
