#include "arfm_vo/odometry/calibration_state.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "arfm_vo/pose/chi_square.h"

namespace arfm_vo {
namespace {

/// The correction is known where its columns are known better than this all over the image: no
/// observation is trusted more (LandmarkAlignerOptions::min_sigma_px).
constexpr double kKnownSigmaPx = 0.1;

/// No coefficient is known better: a lens is not quite what its model says.
constexpr double kModelSigmaPx = 0.05;

/// How far the right camera may have turned at once, about each axis.
constexpr double kTurnSigma_rad = 1e-3;

/// What is held in an adjustment, px: nothing to it.
constexpr double kHeldSigmaPx = 1e-3;

/// Windows of a camera that has not turned lie within this quantile.
constexpr double kSameProbability = 0.999;

/// The square of what windows find, in what their residuals say, before any has told; and the
/// number of windows that this counts for.
constexpr double kScatter = 3, kNumWindows = 1;

/// Of a vector of three with this covariance, 1 in the mean.
double Square(const Eigen::Vector3d& x, const Eigen::Matrix3d& covariance) {
  return x.dot(covariance.ldlt().solve(x)) / 3;
}

constexpr int kFocalLength = StereoCorrection::kNumField + RadialBasis::kFocalLength;

}  // namespace

CalibrationState::CalibrationState(const StereoCamera& camera, bool may_learn,
                                   const CorrectionBelief& known)
    : camera_(camera),
      may_learn_(may_learn),
      is_open_(may_learn && known.MaxColumnSigma(camera) > kKnownSigmaPx),
      by_turn_(CorrectionBelief::ByTurn(camera)),
      prior_(known),
      correction_(known),
      considered_(CorrectionBelief::Isotropic(kModelSigmaPx).covariance),
      scatter_(kScatter),
      num_pairs_(kNumWindows) {
  considered_(kFocalLength, kFocalLength) += known.covariance(kFocalLength, kFocalLength);
  prior_.covariance.row(kFocalLength).setZero();
  prior_.covariance.col(kFocalLength).setZero();
  prior_.covariance(kFocalLength, kFocalLength) = kHeldSigmaPx * kHeldSigmaPx;
}

CorrectionBelief CalibrationState::OpenToATurn() const {
  CorrectionBelief open = CorrectionBelief::Isotropic(kHeldSigmaPx);
  open.mean = correction_.mean;
  open.covariance += kTurnSigma_rad * kTurnSigma_rad * by_turn_ * by_turn_.transpose();
  return open;
}

std::optional<CorrectionBelief> CalibrationState::Prior() const {
  return is_open_ ? std::optional(prior_) : std::nullopt;
}

bool CalibrationState::Learn(const BundleResult& result, int num_keyframes) {
  const bool is_whole =
      result.status == BundleStatus::kConverged || result.status == BundleStatus::kNotConverged;
  if (!is_whole || result.correction_covariance.isZero(0)) return false;
  correction_ = {result.correction, result.correction_covariance};
  is_open_ = correction_.MaxColumnSigma(camera_) > (std::getenv("CAL_KNOWN") ? std::atof(std::getenv("CAL_KNOWN")) : kKnownSigmaPx);
  correction_.covariance = considered_ + scatter_ * correction_.covariance;
  num_learnt_ = num_keyframes;
  return true;
}

std::optional<CorrectionBelief> CalibrationState::WindowPrior(int num_keyframes) const {
  const int num_new = num_keyframes - std::max(num_learnt_, first_telling_);
  if (!may_learn_ || is_open_ || num_keyframes < kWindow || num_new < 1) {
    return std::nullopt;
  }
  return OpenToATurn();
}

void CalibrationState::Follow(const BundleResult& window, int num_keyframes) {
  if (window.status == BundleStatus::kFailed || window.correction_covariance.isZero(0)) return;
  const Eigen::Matrix<double, 3, StereoCorrection::kSize> turn_of =
      (by_turn_.transpose() * by_turn_).ldlt().solve(by_turn_.transpose());
  const Window newest{turn_of * window.correction.coefficients_px,
                      turn_of * window.correction_covariance * turn_of.transpose()};
  const Eigen::Vector3d turn = newest.turn - turn_of * correction_.mean.coefficients_px;
  if (std::getenv("CAL_SAY")) std::fprintf(stderr, "\nwindow %d: mrad %.3f %.3f %.3f square %.1f scatter %.1f factor %.2f it %d t %.3f\n", num_keyframes, 1e3*turn[0],1e3*turn[1],1e3*turn[2], Square(turn, newest.covariance), scatter_, window.covariance_factor, window.num_iterations, window.time_s);
  const bool has_turned = 3 * Square(turn, newest.covariance) > scatter_ * ChiSquareQuantile(3, kSameProbability) &&
                          camera_.fx * turn.norm() > kKnownSigmaPx;
  windows_.push_back(newest);
  if (windows_.size() > kWindow && !has_turned) {
    const Window& before = windows_.front();  // it saw none of the same keyframes
    const double square = Square(newest.turn - before.turn, newest.covariance + before.covariance);
    scatter_ += (square - scatter_) / ++num_pairs_;
  }
  if (windows_.size() > kWindow) windows_.pop_front();
  if (!has_turned) return;
  first_telling_ = num_keyframes - kWindow;
  prior_ = OpenToATurn();
  considered_ = correction_.covariance;
  correction_.covariance += prior_.covariance;
  is_open_ = true;
}

}  // namespace arfm_vo
