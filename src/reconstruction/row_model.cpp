#include "arfm_vo/reconstruction/row_model.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/base/median.h"
#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

/// Share of the older pairs' weight that is left after a pair.
constexpr double kMemory = 0.9;
/// Residuals beyond this many standard deviations lose influence (Cauchy).
constexpr double kRobustWidth = 2;
/// A shift of a whole pair by more than this is a bump, no inaccuracy of the model.
constexpr double kBumpPx = 0.3;
/// No sample is trusted more than this.
constexpr double kMinSigmaPx = 0.1;
constexpr int kMaxIterations = 10;
/// Iterations end when no prediction moves by more.
constexpr double kConvergedPx = 1e-3;

}  // namespace

RowModel::RowModel(const StereoCamera& camera, const CorrectionBelief& prior)
    : camera_(camera),
      prior_information_(
          InvertDefinite(prior.covariance.bottomRightCorner<kNumTerms, kNumTerms>())),
      prior_mean_(prior.mean.coefficients_px.tail<kNumTerms>()),
      information_(prior_information_),
      weighted_sum_(prior_information_ * prior_mean_),
      coefficients_(prior_mean_) {
  camera.Check();
}

RowModel RowModel::AfterAKnock() const {
  const Eigen::MatrixXd by_knock =
      RightTurn::kKnockSigma_rad * CorrectionBelief::ByTurn(camera_).bottomRows<kNumTerms>();
  RowModel after = *this;
  after.information_ =
      InvertDefinite(InvertDefinite(information_) + by_knock * by_knock.transpose());
  after.weighted_sum_ = after.information_ * coefficients_;
  return after;
}

double RowModel::Predict(double u_right, double v_right) const {
  return coefficients_.dot(ImageBasis(camera_, {u_right, v_right}).values);
}

bool RowModel::IsPlausible() const {
  static const double bound = ChiSquareQuantile(kNumTerms, 0.9999);
  const Terms error = coefficients_ - prior_mean_;
  return error.dot(prior_information_ * error) <= bound;
}

std::vector<double> RowModel::Deviations(const std::vector<RowSample>& samples,
                                         const std::vector<Terms>& terms) const {
  std::vector<double> deviations(samples.size());
  for (size_t i = 0; i < samples.size(); ++i) {
    deviations[i] = samples[i].residual_px - coefficients_.dot(terms[i]);
  }
  return deviations;
}

void RowModel::MeasureSpread(std::vector<double> deviations) {
  for (double& deviation : deviations) deviation = std::abs(deviation);
  spread_px_ = std::max(kMinSigmaPx, 1.4826 * Median(std::move(deviations)));
}

void RowModel::Update(const std::vector<RowSample>& samples) {
  if (samples.empty()) return;
  std::vector<Terms> terms;
  terms.reserve(samples.size());
  for (const RowSample& sample : samples) {
    terms.push_back(ImageBasis(camera_, {sample.u_right, sample.v_right}).values);
  }
  if (!IsLearnt()) {
    coefficients_ = prior_mean_;
    coefficients_[0] += Median(Deviations(samples, terms));
  }
  Information information;
  Terms weighted_sum;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const std::vector<double> deviations = Deviations(samples, terms);
    MeasureSpread(deviations);
    information = information_;
    weighted_sum = weighted_sum_;
    for (size_t i = 0; i < samples.size(); ++i) {
      const double sigma = std::hypot(samples[i].sigma_px, kMinSigmaPx);
      const double deviation = deviations[i] / (kRobustWidth * std::max(sigma, spread_px_));
      const double weight = 1 / ((1 + deviation * deviation) * sigma * sigma);
      information.noalias() += (weight * terms[i]) * terms[i].transpose();
      weighted_sum += weight * samples[i].residual_px * terms[i];
    }
    const Terms last = coefficients_;
    coefficients_ = SolveSymmetric(information, weighted_sum);
    if ((coefficients_ - last).lpNorm<1>() < kConvergedPx) break;  // terms are in [-1, 1]
  }
  const std::vector<double> deviations = Deviations(samples, terms);
  MeasureSpread(deviations);
  const double shift_px = Median(deviations);
  shift_px_ = std::abs(shift_px) > kBumpPx ? shift_px : 0;
  num_samples_ += static_cast<double>(samples.size());
  information_ = kMemory * information + (1 - kMemory) * prior_information_;
  weighted_sum_ = kMemory * weighted_sum + (1 - kMemory) * prior_information_ * prior_mean_;
}

}  // namespace arfm_vo
