#include "arfm_vo/matching/adaptive_threshold.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/check.h"

namespace arfm_vo {
namespace {

/// Fewer matches than this say nothing about precision.
constexpr double kMinMatches = 50;

/// The paper's threshold: the variance of the image (eq 5), normalised.
double NormalisedVariance(const GreyStatistics& grey, VarianceNormalisation normalisation) {
  switch (normalisation) {
    case VarianceNormalisation::kOver10000:
      return grey.variance / 10000;
    case VarianceNormalisation::kOver127p5Squared:
      return grey.variance / (127.5 * 127.5);
    case VarianceNormalisation::kOver255Squared:
      return grey.variance / (255.0 * 255.0);
    case VarianceNormalisation::kOverMeanSquared:
      break;
  }
  return grey.mean > 0 ? grey.variance / (grey.mean * grey.mean) : 0;
}

}  // namespace

void AdaptiveThresholdOptions::Check() const {
  const auto is_ratio = [](double value) { return value > 0 && value <= 1; };
  Require(is_ratio(fixed_ratio), "threshold.fixed_ratio must be in (0, 1]");
  Require(is_ratio(min_ratio) && is_ratio(max_ratio) && min_ratio <= max_ratio,
          "threshold.min_ratio and threshold.max_ratio must be in (0, 1], in this order");
  Require(wanted_precision > 0 && wanted_precision < 1,
          "threshold.wanted_precision must be in (0, 1)");
  Require(memory >= 0 && memory < 1, "threshold.memory must be in [0, 1)");
}

AdaptiveThreshold::AdaptiveThreshold(const AdaptiveThresholdOptions& options)
    : options_(options), false_matches_ratio_(options.fixed_ratio) {
  options.Check();
}

double AdaptiveThreshold::Ratio(const GreyStatistics& grey) const {
  double ratio = options_.fixed_ratio;
  if (options_.rule == ThresholdRule::kVariance) {
    ratio = NormalisedVariance(grey, options_.normalisation);
  } else if (options_.rule == ThresholdRule::kFalseMatches) {
    ratio = false_matches_ratio_;
  }
  return std::clamp(ratio, options_.min_ratio, options_.max_ratio);
}

void AdaptiveThreshold::Learn(const std::vector<RatedMatch>& matches, double seen_share) {
  Require(seen_share > 0 && seen_share <= 1, "adaptive threshold: seen_share must be in (0, 1]");
  for (int bin = 0; bin < kNumBins; ++bin) {
    num_matches_[bin] *= options_.memory;
    num_wrong_[bin] *= options_.memory;
  }
  for (const RatedMatch& match : matches) {
    if (!std::isfinite(match.ratio)) continue;
    const int bin = std::clamp(static_cast<int>(match.ratio * kNumBins), 0, kNumBins - 1);
    num_matches_[bin] += 1;
    if (match.is_surely_wrong) num_wrong_[bin] += 1 / seen_share;
  }
  false_matches_ratio_ = RatioForPrecision();
}

double AdaptiveThreshold::RatioForPrecision() const {
  double matches = 0, wrong = 0, ratio = options_.min_ratio;
  for (int bin = 0; bin < kNumBins; ++bin) {
    matches += num_matches_[bin];
    wrong += num_wrong_[bin];
    const bool is_precise = wrong <= (1 - options_.wanted_precision) * matches;
    if (matches > 0 && is_precise) ratio = (bin + 1.0) / kNumBins;
  }
  return matches < kMinMatches ? options_.fixed_ratio : ratio;
}

}  // namespace arfm_vo
