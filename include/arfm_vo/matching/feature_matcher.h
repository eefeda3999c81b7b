#pragma once

#include <string>
#include <utility>
#include <vector>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/features/features.h"
#include "arfm_vo/matching/match.h"

namespace arfm_vo {

/// The four strategies that the paper compares.
enum class MatchStrategy {
  kSurf,             ///< every descriptor with every other
  kSurfRansac,       ///< the same, then RANSAC on the epipolar geometry
  kSurfFlann,        ///< approximate search by kd-trees, both ways
  kSurfFlannRansac,  ///< the same, then RANSAC: the paper's choice
};
inline std::vector<std::pair<std::string, MatchStrategy>> ListNames(MatchStrategy) {
  return {{"surf", MatchStrategy::kSurf},
          {"surf_ransac", MatchStrategy::kSurfRansac},
          {"surf_flann", MatchStrategy::kSurfFlann},
          {"surf_flann_ransac", MatchStrategy::kSurfFlannRansac}};
}

struct FeatureMatcherOptions {
  MatchStrategy strategy = MatchStrategy::kSurfFlannRansac;  ///< of stereo
  /// Rectified pairs: rows of a match may differ by this times the larger scale over 1.2, and
  /// disparity is not negative; 0: any match, for pairs that are not rectified.
  double max_row_difference_px = 0;

  void Check() const;
  ARFM_FIELDS(strategy)
};

/// Matches the features of two images over the whole image: nearest neighbours both ways, ratio
/// test, cross-check, epipolar RANSAC.
class FeatureMatcher {
 public:
  /// Throws std::invalid_argument where an option is wrong.
  explicit FeatureMatcher(const FeatureMatcherOptions& options);

  /// `ratio_threshold`: nearest over second-nearest distance, see RatioThreshold. Empty where a
  /// strategy with RANSAC finds no consensus.
  Matches MatchFeatures(const Features& first, const Features& second,
                        double ratio_threshold) const;

 private:
  FeatureMatcherOptions options_;
};

}  // namespace arfm_vo
