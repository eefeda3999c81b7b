#include "arfm_vo/odometry/correction_learner.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <vector>

#include "arfm_vo/base/median.h"
#include "arfm_vo/bundle_adjustment/bundle_reprojection.h"
#include "arfm_vo/pose/chi_square.h"

namespace arfm_vo {
namespace {

/// The correction is known where its columns are known better than this all over the image: no
/// observation is trusted more (LandmarkAlignerOptions::min_sigma_px).
constexpr double kKnownSigmaPx = 0.1;

/// The same observations place the points that the odometry then goes by, so their errors count
/// again in each pose: so much larger a variance makes the poses' covariance consistent on
/// simulated drives (simulated_run_test: NEES).
constexpr double kTrackCorrelation = 3;

/// No coefficient is known better: so much do drives with the same camera differ, whatever the
/// statistics of one say (docs/self_calibration.md).
constexpr double kModelSigmaPx = 0.05;

/// Rows that are off by more than this, the median of a keyframe, in so many keyframes on end, say
/// that the camera has changed.
constexpr double kContradictionPx = 0.5;
constexpr int kMaxContradictions = 10;

/// What an earlier drive has learnt stands where its columns lie within this quantile of what is
/// found.
constexpr double kSameProbability = 0.95;

/// The focal length of both images shows in turns: after so much more turning the correction is
/// learnt anew from all keyframes.
constexpr double kTellingTurn_rad = 0.5;

bool IsKnown(const CorrectionBelief& correction, const StereoCamera& camera) {
  const double model_px = CorrectionBelief::Isotropic(kModelSigmaPx).MaxColumnSigma(camera);
  return correction.MaxColumnSigma(camera) <=
         std::hypot(std::sqrt(kTrackCorrelation) * kKnownSigmaPx, model_px);
}

/// Whether the columns of a camera with the correction `mean` would be found so.
bool Allows(const CorrectionBelief& found, const StereoCorrection& mean) {
  constexpr int kNum = StereoCorrection::kNumField;
  const auto apart = (found.mean.coefficients_px - mean.coefficients_px).head<kNum>().eval();
  const auto allowed = found.covariance.topLeftCorner<kNum, kNum>().eval();
  return apart.dot(allowed.llt().solve(apart)) <= ChiSquareQuantile(kNum, kSameProbability);
}

}  // namespace

CorrectionLearner::CorrectionLearner(const StereoCamera& camera, bool may_learn,
                                     const CorrectionBelief& known)
    : camera_(camera),
      may_learn_(may_learn),
      prior_(known),
      correction_(known),
      is_learning_(may_learn && !IsKnown(known, camera)) {
  if (!known.is_of_earlier_drive || !may_learn || is_learning_) return;
  earlier_ = known;
  earlier_->is_of_earlier_drive = false;
  prior_ = correction_ = known.Unconfirmed(camera);
  is_learning_ = true;
}

std::optional<CorrectionBelief> CorrectionLearner::Prior() const {
  return is_learning_ ? std::optional(prior_) : std::nullopt;
}

void CorrectionLearner::CheckRows(const Keyframe& keyframe, int index) {
  if (is_learning_ || !may_learn_) return;
  std::vector<double> deviations_px;
  for (const LandmarkObservation& observation : keyframe.observations) {
    if (!observation.has_right) continue;
    const Eigen::Vector2d left = observation.pixels.head<2>(), right = observation.pixels.tail<2>();
    const double off = NominalRightPixel(camera_, correction_.mean, right).y() -
                       NominalLeftPixel(camera_, correction_.mean, left).y();
    deviations_px.push_back(std::abs(off));
  }
  if (deviations_px.empty()) return;
  num_contradictions_ =
      Median(std::move(deviations_px)) > kContradictionPx ? num_contradictions_ + 1 : 0;
  if (num_contradictions_ < kMaxContradictions) return;
  num_contradictions_ = 0;
  first_telling_ = index - kMaxContradictions;
  prior_ = correction_ = CorrectionBelief::OfCalibration(camera_);
  is_learning_ = true;
}

void CorrectionLearner::LearnFromTurns() {
  is_learning_ |= may_learn_ && turned_rad_ > learnt_at_rad_ + kTellingTurn_rad;
}

bool CorrectionLearner::Learn(const BundleResult& result) {
  if (!is_learning_) return false;
  const bool is_whole =
      result.status == BundleStatus::kConverged || result.status == BundleStatus::kNotConverged;
  if (!is_whole || result.correction_covariance.isZero(0)) return false;
  CorrectionBelief found{result.correction, kTrackCorrelation * result.correction_covariance};
  found.covariance.diagonal().array() += kModelSigmaPx * kModelSigmaPx;
  is_learning_ = !IsKnown(found, camera_);
  learnt_at_rad_ = turned_rad_;
  if (earlier_ && !Allows(found, earlier_->mean)) earlier_.reset();
  const bool stands = earlier_.has_value();
  if (stands) found.mean = earlier_->mean;
  correction_ = found;
  if (stands && !is_learning_) {
    prior_ = *earlier_;
    earlier_.reset();
  }
  return stands;
}

}  // namespace arfm_vo
