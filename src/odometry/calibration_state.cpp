#include "arfm_vo/odometry/calibration_state.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

/// The correction is found where its columns are known better than this all over the image: no
/// observation is trusted more, nor is a window (LandmarkAlignerOptions::min_sigma_px).
constexpr double kObservationSigmaPx = 0.1;

/// No coefficient is known better: a lens is not quite what its model says. Where the columns are
/// known as well, there is nothing more to learn.
constexpr double kModelSigmaPx = 0.05;

/// What an adjustment holds, px.
constexpr double kHeldSigmaPx = 1e-3;

/// How far from the correction a window looks for it, about each axis.
constexpr double kTurnSigma_rad = 1e-3;

/// Windows of a camera that stands lie within this quantile.
constexpr double kStillProbability = 0.99;

/// What an earlier drive has found stands where its columns lie within this quantile.
constexpr double kSameProbability = 0.95;

/// The focal length of both images, and their radial distortion, show where the rover turns: after
/// so much of it the correction is learnt anew from all keyframes.
constexpr double kTellingTurn_rad = 0.5;

/// The tangential distortion that calibrations leave has no one size: a prior that is contradicted
/// gives way as Student's t of so many degrees of freedom would (Lange, Little, Taylor, Robust
/// statistical modeling using the t distribution, JASA 1989).
constexpr double kTangentialFreedom = 2;

constexpr int kTangential = StereoCorrection::kNumField + LensBasis::kNumRadial;
constexpr int kFocalLength = StereoCorrection::kNumField + LensBasis::kFocalLength;

}  // namespace

CalibrationState::CalibrationState(const StereoCamera& camera, bool may_learn,
                                   const CorrectionBelief& known)
    : camera_(camera),
      may_learn_(may_learn),
      is_open_(may_learn &&
               (known.is_of_earlier_drive || known.MaxColumnSigma(camera) > kModelSigmaPx)),
      by_turn_(CorrectionBelief::ByTurn(camera)),
      to_turn_(CorrectionBelief::ToTurn(camera)),
      prior_(known),
      learnt_(known),
      correction_(known) {
  correction_.is_of_earlier_drive = false;
  if (!may_learn || !known.is_of_earlier_drive) return;
  prior_ = CorrectionBelief::OfCalibration(camera);
  remembered_ = known.mean;
  learnt_ = correction_ = known.AfterAPause(camera);
}

void CalibrationState::AddTurn(double turn_rad) {
  turned_rad_ += turn_rad;
  is_open_ |= may_learn_ && turned_rad_ > kTellingTurn_rad;
}

std::optional<CorrectionBelief> CalibrationState::Prior() const {
  if (!is_open_) return std::nullopt;
  CorrectionBelief prior = prior_;
  constexpr int kNum = LensBasis::kNumTangential;
  auto variances = prior.covariance.diagonal().segment<kNum>(kTangential);
  const auto off = (learnt_.mean.coefficients_px - prior.mean.coefficients_px).eval();
  const double squares =
      (off.segment<kNum>(kTangential).array().square() / variances.array()).sum();
  variances *= std::max(1.0, (kTangentialFreedom + squares) / (kTangentialFreedom + kNum));
  prior.covariance.row(kFocalLength) *= std::sqrt(kScatter / scatter_of_windows_.value());
  prior.covariance.col(kFocalLength) *= std::sqrt(kScatter / scatter_of_windows_.value());
  return prior;
}

bool CalibrationState::Learn(const BundleResult& result, int num_keyframes) {
  if (result.correction_covariance.isZero(0)) return false;
  learnt_ = {result.correction, result.correction_covariance};
  TakeNews(learnt_);
  const double sigma_px = learnt_.MaxColumnSigma(camera_);
  is_open_ = sigma_px > kModelSigmaPx;
  is_found_ |= sigma_px <= kObservationSigmaPx;
  num_learnt_ = num_keyframes;
  turn_covariance_.setZero();
  turned_rad_ = 0;
  Tell();
  if (remembered_ && !Allows(*remembered_)) remembered_.reset();
  if (!remembered_) return true;
  learnt_.mean = *remembered_;
  Tell();
  return false;
}

/// Whether the columns of a camera with the correction `mean` would be found so.
bool CalibrationState::Allows(const StereoCorrection& mean) const {
  constexpr int kNum = StereoCorrection::kNumField;
  const auto off = (correction_.mean.coefficients_px - mean.coefficients_px).head<kNum>();
  const auto allowed = correction_.covariance.topLeftCorner<kNum, kNum>();
  return SquaredMahalanobis(off, allowed) <= ChiSquareQuantile(kNum, kSameProbability);
}

void CalibrationState::Tell() {
  correction_ = {learnt_.mean, scatter_.value() * learnt_.covariance +
                                   CorrectionBelief::Isotropic(kModelSigmaPx).covariance +
                                   Propagate(by_turn_, turn_covariance_)};
}

std::optional<CorrectionBelief> CalibrationState::WindowPrior(int num_keyframes) const {
  const bool is_news = num_keyframes > num_learnt_ && num_keyframes >= first_telling_ + kWindow;
  if (!may_learn_ || !is_news) return std::nullopt;
  return OpenToATurn();
}

void CalibrationState::BeginTurn(const Eigen::Matrix3d& covariance, int first_telling) {
  windows_.clear();
  found_.reset();
  turn_covariance_ += covariance;
  first_telling_ = first_telling;
  is_open_ &= !is_found_;
}

void CalibrationState::Turn(const RightTurn& turn, int keyframe) {
  if (!may_learn_) return;
  BeginTurn(turn.covariance, keyframe);
  learnt_.mean.coefficients_px += by_turn_ * turn.turn_rad;
  Tell();
  prior_ = OpenToATurn();
  prior_.covariance += correction_.covariance;
}

CorrectionBelief CalibrationState::OpenToATurn() const {
  CorrectionBelief open = CorrectionBelief::Isotropic(kHeldSigmaPx);
  open.mean = correction_.mean;
  open.covariance +=
      Propagate(by_turn_, kTurnSigma_rad * kTurnSigma_rad * Eigen::Matrix3d::Identity());
  return open;
}

void CalibrationState::TakeNews(const CorrectionBelief& newest) {
  const std::optional<CorrectionBelief> before = std::exchange(found_, newest);
  if (!before) return;
  // The newest has all that the one before had and more: by what is less unknown it may move.
  constexpr int kNum = StereoCorrection::kNumPlacing;
  const auto known = before->PlacingCovariance();
  const auto left = SolveDefinite(known, newest.PlacingCovariance());
  if (!left || left->trace() >= kNum) return;
  const auto moved = (newest.mean.coefficients_px - before->mean.coefficients_px).head<kNum>();
  scatter_.Add(SquaredMahalanobis(moved, known), kNum - left->trace());
}

void CalibrationState::TakeScatter(const Window& newest) {
  windows_.push_back(newest);
  if (windows_.size() <= kWindow) return;
  const Window before = windows_.front();
  windows_.pop_front();
  const double apart =
      SquaredMahalanobis(newest.turn - before.turn, newest.covariance + before.covariance);
  scatter_.Add(apart, 3);
  scatter_of_windows_.Add(apart, 3);
  Tell();
}

void CalibrationState::Follow(const BundleResult& window, int num_keyframes) {
  const bool was_turning = std::exchange(is_turning_, false);
  if (window.status == BundleStatus::kFailed || window.correction_covariance.isZero(0)) return;
  const Window newest{to_turn_ * window.correction.coefficients_px,
                      Propagate(to_turn_, window.correction_covariance)};
  const Eigen::Vector3d off = newest.turn - to_turn_ * correction_.mean.coefficients_px;
  const Eigen::Matrix3d noise =
      scatter_.value() * newest.covariance +
      Propagate(to_turn_, CorrectionBelief::Isotropic(kObservationSigmaPx).covariance);
  const Eigen::Matrix3d known = Propagate(to_turn_, correction_.covariance);
  const double ratio = SquaredMahalanobis(off, known + noise) / 3;
  // A turn that has begun goes on; one that begins must stand out from many windows that tell none.
  const double limit = was_turning ? 1 : ChiSquareQuantile(3, kStillProbability) / 3;
  is_turning_ = ratio > limit;
  if (is_turning_) {
    BeginTurn((1 - 1 / ratio) / 3 * off * off.transpose(), num_keyframes - kWindow);
  } else if (is_found_) {
    TakeScatter(newest);
  }
  const Eigen::Matrix3d gain = turn_covariance_ * (turn_covariance_ + noise).inverse();
  learnt_.mean.coefficients_px += by_turn_ * gain * off;
  turn_covariance_ -= gain * turn_covariance_;
  Tell();
  if (!is_turning_) return;
  prior_ = OpenToATurn();
  prior_.covariance += correction_.covariance;
}

}  // namespace arfm_vo
