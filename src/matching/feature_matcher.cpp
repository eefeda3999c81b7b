#include "arfm_vo/matching/feature_matcher.h"

#include <algorithm>
#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/matching/epipolar_ransac.h"
#include "arfm_vo/matching/exact_matcher.h"
#include "arfm_vo/matching/flann_matcher.h"

namespace arfm_vo {
namespace {

bool IsOnRow(const Keypoint& left, const Keypoint& right, double max_row_difference_px) {
  const double scale = std::max(left.scale, right.scale) / kSmallestScale;
  return left.x >= right.x && std::abs(left.y - right.y) <= max_row_difference_px * scale;
}

template <class IsWanted>
void Keep(Matches& matches, IsWanted&& is_wanted) {
  Matches kept;
  for (size_t i = 0; i < matches.size(); ++i) {
    if (is_wanted(i)) kept.push_back(matches[i]);
  }
  matches = std::move(kept);
}

}  // namespace

void FeatureMatcherOptions::Check() const {
  Require(max_row_difference_px >= 0, "matcher.max_row_difference_px must not be negative");
}

FeatureMatcher::FeatureMatcher(const FeatureMatcherOptions& options) : options_(options) {
  options.Check();
}

Matches FeatureMatcher::MatchFeatures(const Features& first, const Features& second,
                                      double ratio_threshold) const {
  const MatchStrategy strategy = options_.strategy;
  const bool uses_flann =
      strategy == MatchStrategy::kSurfFlann || strategy == MatchStrategy::kSurfFlannRansac;
  const bool uses_ransac =
      strategy == MatchStrategy::kSurfRansac || strategy == MatchStrategy::kSurfFlannRansac;
  Matches matches = SelectMatches(
      uses_flann ? FindNeighboursByFlann(first, second) : FindNeighboursExactly(first, second),
      ratio_threshold);
  if (options_.max_row_difference_px > 0) {
    Keep(matches, [&](size_t i) {
      return IsOnRow(first.keypoints[matches[i].first], second.keypoints[matches[i].second],
                     options_.max_row_difference_px);
    });
  }
  if (uses_ransac) {
    const auto geometry = FindEpipolarGeometry(first.keypoints, second.keypoints, matches);
    if (!geometry) return {};
    Keep(matches, [&](size_t i) { return geometry->is_inlier[i] != 0; });
  }
  return matches;
}

}  // namespace arfm_vo
