#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/image/grey_statistics.h"

namespace arfm_vo {

/// Where the ratio threshold comes from.
enum class ThresholdRule {
  kFixed,         ///< always `fixed_ratio`
  kVariance,      ///< the paper's: from the variance of the image (eqs 4, 5)
  kFalseMatches,  ///< from the share of wrong matches seen at each ratio
};
inline std::vector<std::pair<std::string, ThresholdRule>> ListNames(ThresholdRule) {
  return {{"fixed", ThresholdRule::kFixed},
          {"variance", ThresholdRule::kVariance},
          {"false_matches", ThresholdRule::kFalseMatches}};
}

/// What the variance is divided by. The paper takes "the variance of the image" as threshold, with
/// 0.375 and 0.734 for its two pairs, and does not say how grey levels are scaled: in [0, 1] a
/// variance is at most 0.25.
enum class VarianceNormalisation {
  kOverMeanSquared,   ///< mean^2: free of exposure; reaches both values on ordinary images
  kOver10000,         ///< 100^2: as if grey levels were per cent; needs sigma 61 and 86
  kOver127p5Squared,  ///< [-1, 1]: needs sigma 78 and 109; 0.2 to 0.3 on street scenes
  kOver255Squared,    ///< [0, 1]: at most 0.25, so mostly clamped
};
inline std::vector<std::pair<std::string, VarianceNormalisation>> ListNames(VarianceNormalisation) {
  return {{"variance_over_mean_squared", VarianceNormalisation::kOverMeanSquared},
          {"variance_over_10000", VarianceNormalisation::kOver10000},
          {"variance_over_127_5_squared", VarianceNormalisation::kOver127p5Squared},
          {"variance_over_255_squared", VarianceNormalisation::kOver255Squared}};
}

struct AdaptiveThresholdOptions {
  ThresholdRule rule = ThresholdRule::kFixed;  ///< of the ratio nearest / second
  double fixed_ratio = 0.8;                    ///< also the start of rule false_matches
  /// Of the grey variance, for rules that go by it.
  VarianceNormalisation normalisation = VarianceNormalisation::kOverMeanSquared;
  double min_ratio = 0.3,
         max_ratio = 0.95;         ///< whatever the rule says, the threshold is in between
  double wanted_precision = 0.95;  ///< rule false_matches: share of matches that are right
  double memory = 0.8;  ///< rule false_matches: weight that the pairs before keep after a pair

  void Check() const;
  template <class Visitor>
  void VisitFields(Visitor&& visit) {
    visit("rule", rule);
    visit("fixed_ratio", fixed_ratio);
    visit("normalisation", normalisation);
    visit("min_ratio", min_ratio);
    visit("max_ratio", max_ratio);
    visit("wanted_precision", wanted_precision);
  }
};

/// A match before the ratio test, as rectified stereo sees it.
struct RatedMatch {
  double ratio = 0;              ///< nearest over second-nearest distance
  bool is_surely_wrong = false;  ///< rows disagree or disparity is negative
};

/// The threshold of the ratio test, nearest over second-nearest distance.
class AdaptiveThreshold {
 public:
  /// Throws std::invalid_argument where an option is wrong.
  explicit AdaptiveThreshold(const AdaptiveThresholdOptions& options);

  /// The threshold for an image.
  double Ratio(const GreyStatistics& grey) const;
  /// Learns from all mutual nearest neighbours of a pair, for the next pairs (rule false_matches).
  /// `seen_share` of the wrong matches are surely wrong; the others look right by chance.
  void Learn(const std::vector<RatedMatch>& matches, double seen_share);

 private:
  static constexpr int kNumBins = 50;

  double RatioForPrecision() const;

  AdaptiveThresholdOptions options_;
  std::array<double, kNumBins> num_matches_{}, num_wrong_{};  ///< by ratio, over the latest pairs
  double false_matches_ratio_;
};

}  // namespace arfm_vo
