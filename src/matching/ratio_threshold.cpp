#include "arfm_vo/matching/ratio_threshold.h"

#include <algorithm>

#include "arfm_vo/base/check.h"

namespace arfm_vo {

void RatioThresholdOptions::Check() const {
  const auto is_ratio = [](double value) { return value > 0 && value <= 1; };
  Require(is_ratio(fixed_ratio), "threshold.fixed_ratio must be in (0, 1]");
  Require(is_ratio(min_ratio) && is_ratio(max_ratio) && min_ratio <= max_ratio,
          "threshold.min_ratio and threshold.max_ratio must be in (0, 1], in this order");
}

double RatioThreshold(const GreyStatistics& grey, const RatioThresholdOptions& options) {
  double ratio = options.fixed_ratio;
  if (options.rule == ThresholdRule::kVariance) {
    ratio = grey.mean > 0 ? grey.variance / (grey.mean * grey.mean) : 0;
  }
  return std::clamp(ratio, options.min_ratio, options.max_ratio);
}

}  // namespace arfm_vo
