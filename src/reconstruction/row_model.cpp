#include "arfm_vo/reconstruction/row_model.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

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

double Median(std::vector<double> values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

RowModel::RowModel(const StereoCamera& camera, const CorrectionBelief& prior)
    : camera_(camera),
      prior_information_(prior.covariance.bottomRightCorner<kNumTerms, kNumTerms>().inverse()),
      prior_mean_(prior.mean.coefficients_px.tail<kNumTerms>()),
      information_(prior_information_),
      weighted_sum_(prior_information_ * prior_mean_),
      coefficients_(prior_mean_) {
  camera.Check();
}

double RowModel::Predict(double u_right, double v_right) const {
  return coefficients_.dot(ImageBasis(camera_, {u_right, v_right}).values);
}

void RowModel::MeasureSpread(const std::vector<RowSample>& samples) {
  std::vector<double> deviations;
  for (const RowSample& sample : samples) {
    deviations.push_back(std::abs(sample.residual_px - Predict(sample.u_right, sample.v_right)));
  }
  spread_px_ = std::max(kMinSigmaPx, 1.4826 * Median(deviations));
}

void RowModel::Update(const std::vector<RowSample>& samples) {
  if (samples.empty()) return;
  if (!IsLearnt()) {
    std::vector<double> residuals;
    for (const RowSample& sample : samples) residuals.push_back(sample.residual_px);
    coefficients_ = prior_mean_;
    for (size_t i = 0; i < samples.size(); ++i) {
      residuals[i] -= Predict(samples[i].u_right, samples[i].v_right);
    }
    coefficients_[0] += Median(residuals);
  }
  Information information;
  Terms weighted_sum;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    MeasureSpread(samples);
    information = information_;
    weighted_sum = weighted_sum_;
    for (const RowSample& sample : samples) {
      const Terms terms = ImageBasis(camera_, {sample.u_right, sample.v_right}).values;
      const double sigma = std::hypot(sample.sigma_px, kMinSigmaPx);
      const double width = kRobustWidth * std::max(sigma, spread_px_);
      const double deviation = (sample.residual_px - coefficients_.dot(terms)) / width;
      const double weight = 1 / ((1 + deviation * deviation) * sigma * sigma);
      information += weight * terms * terms.transpose();
      weighted_sum += weight * sample.residual_px * terms;
    }
    const Terms last = coefficients_;
    coefficients_ = information.ldlt().solve(weighted_sum);
    if ((coefficients_ - last).lpNorm<1>() < kConvergedPx) break;  // terms are in [-1, 1]
  }
  MeasureSpread(samples);
  std::vector<double> deviations;
  for (const RowSample& sample : samples) {
    deviations.push_back(sample.residual_px - Predict(sample.u_right, sample.v_right));
  }
  const double shift_px = Median(std::move(deviations));
  shift_px_ = std::abs(shift_px) > kBumpPx ? shift_px : 0;
  num_samples_ += static_cast<double>(samples.size());
  information_ = kMemory * information + (1 - kMemory) * prior_information_;
  weighted_sum_ = kMemory * weighted_sum + (1 - kMemory) * prior_information_ * prior_mean_;
}

}  // namespace arfm_vo
