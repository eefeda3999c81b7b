#include "arfm_vo/reconstruction/row_model.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// Share of the older pairs' weight that is left after a pair.
constexpr double kMemory = 0.9;
/// A priori the terms are zero within this, px: so few or badly spread samples do no harm.
constexpr double kPriorSigmaPx[] = {2, 2, 2, 2, 1, 1};
/// Residuals beyond this many standard deviations lose influence (Cauchy).
constexpr double kRobustWidth = 2;
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

RowModel::RowModel(int width, int height)
    : half_width_(0.5 * width),
      half_height_(0.5 * height),
      information_(Information::Zero()),
      weighted_sum_(Terms::Zero()),
      coefficients_(Terms::Zero()) {
  Require(width > 0 && height > 0, "row model: the image size must be positive");
  for (int i = 0; i < kNumTerms; ++i) {
    information_(i, i) = 1 / (kPriorSigmaPx[i] * kPriorSigmaPx[i]);
  }
}

RowModel::Terms RowModel::TermsAt(double u_left, double v_left) const {
  const double x = (u_left - half_width_) / half_width_, y = (v_left - half_height_) / half_height_;
  Terms terms;
  terms << 1, x, y, x * y, x * x, y * y;
  return terms;
}

double RowModel::Predict(double u_left, double v_left) const {
  return coefficients_.dot(TermsAt(u_left, v_left));
}

void RowModel::MeasureSpread(const std::vector<RowSample>& samples) {
  std::vector<double> deviations;
  for (const RowSample& sample : samples) {
    deviations.push_back(std::abs(sample.residual_px - Predict(sample.u_left, sample.v_left)));
  }
  spread_px_ = std::max(kMinSigmaPx, 1.4826 * Median(deviations));
}

void RowModel::Update(const std::vector<RowSample>& samples) {
  if (samples.empty()) return;
  if (!IsLearnt()) {
    std::vector<double> residuals;
    for (const RowSample& sample : samples) residuals.push_back(sample.residual_px);
    coefficients_ = Terms::Unit(0) * Median(residuals);
  }
  Information information;
  Terms weighted_sum;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    MeasureSpread(samples);
    information = information_;
    weighted_sum = weighted_sum_;
    for (const RowSample& sample : samples) {
      const Terms terms = TermsAt(sample.u_left, sample.v_left);
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
  num_samples_ += static_cast<double>(samples.size());
  Information prior = Information::Zero();
  for (int i = 0; i < kNumTerms; ++i) prior(i, i) = 1 / (kPriorSigmaPx[i] * kPriorSigmaPx[i]);
  information_ = kMemory * information + (1 - kMemory) * prior;
  weighted_sum_ = kMemory * weighted_sum;
}

}  // namespace arfm_vo
