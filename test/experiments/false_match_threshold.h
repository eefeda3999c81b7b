#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace arfm_vo {

/// A match before the ratio test, as rectified stereo sees it.
struct RatedMatch {
  double ratio = 0;              ///< nearest over second-nearest distance
  bool is_surely_wrong = false;  ///< rows disagree or disparity is negative
};

/// A ratio threshold learnt from the matches themselves: the largest at which the share of wrong
/// ones, as rectified stereo shows them, is as wanted. An experiment: it was no better than the
/// best fixed ratio (docs/experiments.md).
class FalseMatchThreshold {
 public:
  /// For the next pair.
  double Ratio() const { return std::clamp(ratio_, kMinRatio, kMaxRatio); }
  /// Learns from all mutual nearest neighbours of a pair. `seen_share`, in (0, 1], of the wrong
  /// matches are surely wrong; the others look right by chance.
  void Learn(const std::vector<RatedMatch>& matches, double seen_share) {
    for (int bin = 0; bin < kNumBins; ++bin) {
      num_matches_[bin] *= kMemory;
      num_wrong_[bin] *= kMemory;
    }
    for (const RatedMatch& match : matches) {
      if (!std::isfinite(match.ratio)) continue;
      const int bin = std::clamp(static_cast<int>(match.ratio * kNumBins), 0, kNumBins - 1);
      num_matches_[bin] += 1;
      if (match.is_surely_wrong) num_wrong_[bin] += 1 / seen_share;
    }
    ratio_ = RatioForPrecision();
  }

 private:
  static constexpr int kNumBins = 50;
  static constexpr double kFirstRatio = 0.8, kMinRatio = 0.3, kMaxRatio = 0.95;
  static constexpr double kWantedPrecision = 0.95;
  static constexpr double kMemory = 0.8;     ///< weight that the pairs before keep after a pair
  static constexpr double kMinMatches = 50;  ///< fewer say nothing about precision

  double RatioForPrecision() const {
    double matches = 0, wrong = 0, ratio = kMinRatio;
    for (int bin = 0; bin < kNumBins; ++bin) {
      matches += num_matches_[bin];
      wrong += num_wrong_[bin];
      const bool is_precise = wrong <= (1 - kWantedPrecision) * matches;
      if (matches > 0 && is_precise) ratio = (bin + 1.0) / kNumBins;
    }
    return matches < kMinMatches ? kFirstRatio : ratio;
  }

  std::array<double, kNumBins> num_matches_{}, num_wrong_{};  ///< by ratio, over the latest pairs
  double ratio_ = kFirstRatio;
};

}  // namespace arfm_vo
