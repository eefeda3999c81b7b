#include "arfm_vo/odometry/standstill_lock.h"


#include "arfm_vo/base/check.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

constexpr int kMinSharedPoints = 20;

}  // namespace

void StandstillOptions::Check() const {
  Require(max_point_shift_px > 0, "standstill.max_point_shift_px must be positive");
  Require(min_resting_fraction > 0.5 && min_resting_fraction <= 1,
          "standstill.min_resting_fraction must be in (0.5, 1]");
  Require(max_significance > 0, "standstill.max_significance must be positive");
  Require(max_translation_m > 0, "standstill.max_translation_m must be positive");
  Require(max_rotation_rad > 0, "standstill.max_rotation_rad must be positive");
}

StandstillLock::StandstillLock(const StandstillOptions& options) : options_(options) {
  options.Check();
}

std::optional<Rigid3> StandstillLock::Hold(const PoseEstimate& pose,
                                           const LandmarkObservations& observations) {
  if (options_.enabled && PointsRest(observations) && MotionIsNoise(pose)) return anchor_pose_;
  anchor_ = observations;
  anchor_pose_ = pose.camera_from_world;
  return std::nullopt;
}

bool StandstillLock::PointsRest(const LandmarkObservations& observations) const {
  int num_shared = 0, num_resting = 0;
  auto anchor = anchor_.begin();
  for (const LandmarkObservation& observation : observations) {
    while (anchor != anchor_.end() && anchor->landmark < observation.landmark) ++anchor;
    if (anchor == anchor_.end()) break;
    if (anchor->landmark != observation.landmark) continue;
    ++num_shared;
    const Eigen::Vector2f shift = (observation.pixels - anchor->pixels).head<2>();
    num_resting += shift.norm() < options_.max_point_shift_px;
  }
  return num_shared >= kMinSharedPoints &&
         num_resting >= options_.min_resting_fraction * num_shared;
}

bool StandstillLock::MotionIsNoise(const PoseEstimate& pose) const {
  const Rigid3 motion = pose.camera_from_world * anchor_pose_.Inverse();
  if (motion.translation.norm() > options_.max_translation_m) return false;
  if (motion.Angle() > options_.max_rotation_rad) return false;
  Eigen::Matrix<double, 6, 1> step;
  step << LogSO3(motion.rotation), motion.translation;
  // Both poses are uncertain, with the same covariance.
  const double squared = 0.5 * SquaredMahalanobis(step, pose.covariance);
  return squared < options_.max_significance * options_.max_significance;
}

}  // namespace arfm_vo
