#include "arfm_vo/matching/feature_matcher.h"

#include <gtest/gtest.h>

#include "matching/random_features.h"

namespace arfm_vo {
namespace {

/// A rectified pair: right features 20 px to the left of the left ones; the first `num_wrong` right
/// ones lie somewhere else, the next `num_alike` look almost like each other.
struct StereoScene {
  Features left = RandomFeatures(300, 1);
  Features right;

  StereoScene(int num_wrong, int num_alike) {
    right = ReversedWithNoise(left, 0.02, 2);
    for (Keypoint& keypoint : right.keypoints) keypoint.x -= 20;
    const Features elsewhere = RandomFeatures(num_wrong, 3);
    for (int i = 0; i < num_wrong; ++i) {
      right.keypoints[i].x = elsewhere.keypoints[i].x;
      right.keypoints[i].y = elsewhere.keypoints[i].y;
    }
    for (int i = num_wrong; i < num_wrong + num_alike; ++i)
      right.descriptors.row(num_wrong).copyTo(right.descriptors.row(i));
  }
  Matches Match(MatchStrategy strategy, double ratio, double max_row_difference_px = 0) const {
    FeatureMatcherOptions options;
    options.strategy = strategy;
    options.max_row_difference_px = max_row_difference_px;
    return FeatureMatcher(options).MatchFeatures(left, right, ratio);
  }
};

TEST(FeatureMatcher, AllStrategiesFindTheRightMatches) {
  const StereoScene scene(0, 0);
  for (const auto& [name, strategy] : ListNames(MatchStrategy{})) {
    const Matches matches = scene.Match(strategy, 0.8);
    EXPECT_GT(matches.size(), 285u) << name;
    for (const Match& match : matches) EXPECT_EQ(match.second, 299 - match.first) << name;
  }
}

TEST(FeatureMatcher, RansacRemovesMatchesOffTheEpipolarLine) {
  const StereoScene scene(60, 0);
  EXPECT_EQ(scene.Match(MatchStrategy::kSurf, 0.8).size(), 300u);
  for (const auto strategy : {MatchStrategy::kSurfRansac, MatchStrategy::kSurfFlannRansac}) {
    const Matches matches = scene.Match(strategy, 0.8);
    EXPECT_GT(matches.size(), 225u);
    EXPECT_LT(matches.size(), 250u);
  }
}

TEST(FeatureMatcher, TheRowBandRemovesMatchesOfOtherRowsOrNegativeDisparity) {
  const StereoScene scene(60, 0);
  const Matches matches = scene.Match(MatchStrategy::kSurf, 0.8, 1);
  EXPECT_GE(matches.size(), 240u);
  EXPECT_LT(matches.size(), 245u);
}

TEST(FeatureMatcher, TheRatioTestRemovesWhatLooksAlike) {
  const StereoScene scene(0, 50);
  const Matches matches = scene.Match(MatchStrategy::kSurf, 0.8);
  EXPECT_EQ(matches.size(), 250u);
  for (const Match& match : matches) EXPECT_GE(match.second, 50);
}

TEST(FeatureMatcher, WithoutConsensusOrInputThereAreNoMatches) {
  const StereoScene scene(300, 0);
  EXPECT_LT(scene.Match(MatchStrategy::kSurfRansac, 0.8).size(), 60u);
  FeatureMatcher matcher({});
  EXPECT_TRUE(matcher.MatchFeatures({}, {}, 0.8).empty());
  EXPECT_TRUE(matcher.MatchFeatures(scene.left, {}, 0.8).empty());
}

}  // namespace
}  // namespace arfm_vo
