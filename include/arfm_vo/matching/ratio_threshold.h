#pragma once

#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/image/grey_statistics.h"

namespace arfm_vo {

/// Where the ratio threshold comes from.
enum class ThresholdRule {
  kFixed,     ///< always `fixed_ratio`
  kVariance,  ///< the paper's: from the variance of the image (eqs 4, 5)
};
inline std::vector<std::pair<std::string, ThresholdRule>> ListNames(ThresholdRule) {
  return {{"fixed", ThresholdRule::kFixed}, {"variance", ThresholdRule::kVariance}};
}

struct RatioThresholdOptions {
  ThresholdRule rule = ThresholdRule::kFixed;  ///< of the ratio nearest / second
  double fixed_ratio = 0.8;
  /// Whatever the rule says, the threshold is in between.
  double min_ratio = 0.3, max_ratio = 0.95;

  void Check() const;
  ARFM_FIELDS(rule, fixed_ratio, min_ratio, max_ratio)
};

/// The threshold of the ratio test, nearest over second-nearest distance, for an image. The paper
/// takes "the variance of the image", with 0.375 and 0.734 for its two pairs, and does not say how
/// grey levels are scaled; divided by the squared mean it is free of exposure and reaches both
/// values on ordinary images. Other scalings, and a rule that learns from false matches, are
/// compared in docs/experiments.md.
double RatioThreshold(const GreyStatistics& grey, const RatioThresholdOptions& options);

}  // namespace arfm_vo
