#include "arfm_vo/odometry/stereo_skew.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/median.h"
#include "arfm_vo/geometry/correction_belief.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/geometry/right_shift.h"
#include "arfm_vo/geometry/stereo_correction.h"
#include "arfm_vo/odometry/odometry_update.h"

namespace arfm_vo {
namespace {

constexpr double kSkewSigma_s = 0.05;  ///< before anything is known
constexpr double kMinRowSigmaPx = 0.1;
/// Rows that are off by more are not those of one point.
constexpr double kMaxRowPx = 3;
/// A smaller skew may as well be what the model leaves out: recordings with one trigger for both
/// cameras give up to 0.6 ms.
constexpr double kMinSkew_s = 0.001, kSignificance = 3;
constexpr double kMinDepth_m = 0.1;
/// Of what frames told, at each further one: the skew may change.
constexpr double kRemembered = 0.99;
/// Share of the way by which the pose may be off for a skew that was not known on it.
constexpr double kDoubt = 0.1;
/// Known skew that moves what is seen by more than this is not made up for well enough to trust.
constexpr double kMaxShiftPx = 1;

}  // namespace

StereoSkewEstimator::StereoSkewEstimator(const StereoCamera& camera) : camera_(camera) {
  constexpr int kRows = StereoCorrection::kNumField;
  prior_.topLeftCorner<kRows, kRows>() = InvertDefinite(
      CorrectionBelief::OfCalibration(camera).covariance.bottomRightCorner<kRows, kRows>());
  prior_(kRows, kRows) = 1 / (kSkewSigma_s * kSkewSigma_s);
  skew_.sigma_s = kSkewSigma_s;
}

void StereoSkewEstimator::Advance(double stamp_s, const std::optional<PredictedPose>& predicted) {
  const auto found = Found();
  later_from_now_ = found ? MotionIn(found->s, stamp_s, predicted) : Rigid3();
  const double unknown_s = std::hypot(found ? 0 : skew_.s, skew_.sigma_s);
  turn_sigma_rad_ = LogSO3(MotionIn(unknown_s, stamp_s, predicted).rotation);
}

double StereoSkewEstimator::Learn(const LocalMap& map, OdometryUpdate& update) {
  Add(map, update);
  update.skew = Found();
  if (update.pose.IsTracked() && MedianShiftPx(map, update) >= kMaxShiftPx) {
    update.Degrade(Reason::kSkewed);
  }
  const bool is_new = update.skew && !is_known_;
  is_known_ |= is_new;
  return is_new ? kDoubt * update.pose.camera_from_world.Inverse().translation.norm() : 0;
}

void StereoSkewEstimator::Add(const LocalMap& map, const OdometryUpdate& update) {
  const Rigid3& camera_from_world = update.pose.camera_from_world;
  if (!last_) {
    last_ = Last{update.stamp_s, camera_from_world, {}, 0};
    return;
  }
  const double interval_s = update.stamp_s - last_->stamp_s;
  if (interval_s <= 0) return;
  information_ *= kRemembered;
  right_side_ *= kRemembered;
  scatter_ *= kRemembered;
  score_.setZero();
  for (const LandmarkObservation& observation : update.observations) {
    if (!observation.has_right) continue;
    const Eigen::Vector3d& x = map.landmarks().at(observation.landmark).x_in_world;
    const Eigen::Vector3d now = camera_from_world * x, before = last_->camera_from_world * x;
    if (std::min(now.z(), before.z()) < kMinDepth_m) continue;
    const double row_step_px = (camera_.Project(now) - camera_.Project(before)).y();
    AddRow(observation.Pixels(), row_step_px / interval_s, observation.sigma_px);
  }
  scatter_ += score_ * score_.transpose();
  Solve();
  last_ = Last{update.stamp_s, camera_from_world,
               camera_from_world * last_->camera_from_world.Inverse(), interval_s};
}

void StereoSkewEstimator::AddRow(const Eigen::Vector4d& pixels, double row_speed_px_s,
                                 double sigma_px) {
  Vector row;
  row << ImageBasis(camera_, pixels.tail<2>()).values, row_speed_px_s;
  const auto found = Found();
  const double made_up_s = found ? found->s : 0;
  const double residual_px = pixels.w() - pixels.y() + made_up_s * row_speed_px_s;
  const double off_px = residual_px - row.dot(solution_);
  if (std::abs(off_px) > kMaxRowPx) return;
  // Left and right row err alike; Cauchy's weight with a scale of two standard deviations.
  const double sigma = std::max(kMinRowSigmaPx, std::sqrt(2.) * sigma_px);
  const double weight = 1 / (sigma * sigma + off_px * off_px / 4);
  information_ += weight * row * row.transpose();
  right_side_ += weight * residual_px * row;
  score_ += weight * off_px * row;
}

void StereoSkewEstimator::Solve() {
  Eigen::Matrix<double, kSize, 2> right_sides;
  right_sides << right_side_, Vector::Unit(kSize - 1);
  const Eigen::MatrixXd solved = SolveSymmetric(information_ + prior_, right_sides);
  solution_ = solved.col(0);
  // Rows of one frame err together, so that frames count, not points (the sandwich estimator).
  const Vector by_score = solved.col(1);
  const double variance = by_score[kSize - 1] + by_score.dot(scatter_ * by_score);
  skew_ = {solution_[kSize - 1], std::sqrt(variance)};
}

std::optional<StereoSkew> StereoSkewEstimator::Found() const {
  const bool is_significant = std::abs(skew_.s) >= kMinSkew_s + kSignificance * skew_.sigma_s;
  return is_significant ? std::optional(skew_) : std::nullopt;
}

Rigid3 StereoSkewEstimator::MotionIn(double duration_s, double stamp_s,
                                     const std::optional<PredictedPose>& predicted) const {
  if (!last_) return {};
  if (predicted && stamp_s > last_->stamp_s) {
    const Rigid3 now_from_last = predicted->camera_from_world * last_->camera_from_world.Inverse();
    return Interpolate({}, now_from_last, duration_s / (stamp_s - last_->stamp_s));
  }
  if (last_->interval_s == 0) return {};
  return Interpolate({}, last_->now_from_before, duration_s / last_->interval_s);
}

double StereoSkewEstimator::MedianShiftPx(const LocalMap& map, const OdometryUpdate& update) const {
  if (later_from_now_.IsIdentity()) return 0;
  std::vector<double> shifts_px;
  for (const LandmarkObservation& observation : update.observations) {
    const Eigen::Vector3d& x = map.landmarks().at(observation.landmark).x_in_world;
    const Eigen::Vector3d x_in_camera = update.pose.camera_from_world * x;
    shifts_px.push_back(ShiftOfRight(camera_, later_from_now_, x_in_camera).norm());
  }
  return Median(std::move(shifts_px));
}

}  // namespace arfm_vo
