#include "arfm_vo/matching/adaptive_threshold.h"

#include <gtest/gtest.h>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

double VarianceRatio(VarianceNormalisation normalisation, const GreyStatistics& grey) {
  AdaptiveThresholdOptions options;
  options.rule = ThresholdRule::kVariance;
  options.normalisation = normalisation;
  return AdaptiveThreshold(options).Ratio(grey);
}

TEST(AdaptiveThreshold, OfTheVarianceByHand) {
  const GreyStatistics grey{100, 6400};
  EXPECT_DOUBLE_EQ(VarianceRatio(VarianceNormalisation::kOverMeanSquared, grey), 0.64);
  EXPECT_DOUBLE_EQ(VarianceRatio(VarianceNormalisation::kOver10000, grey), 0.64);
  EXPECT_DOUBLE_EQ(VarianceRatio(VarianceNormalisation::kOver127p5Squared, grey),
                   6400 / 127.5 / 127.5);
  EXPECT_DOUBLE_EQ(VarianceRatio(VarianceNormalisation::kOver255Squared, {100, 30000}),
                   30000.0 / 255 / 255);
}

TEST(AdaptiveThreshold, ExposureDoesNotChangeVarianceOverMeanSquared) {
  const auto rule = VarianceNormalisation::kOverMeanSquared;
  EXPECT_DOUBLE_EQ(VarianceRatio(rule, {100, 4900}), VarianceRatio(rule, {50, 1225}));
}

TEST(AdaptiveThreshold, StaysInTheUsableRange) {
  const auto rule = VarianceNormalisation::kOverMeanSquared;
  EXPECT_DOUBLE_EQ(VarianceRatio(rule, {100, 1}), 0.3) << "flat image";
  EXPECT_DOUBLE_EQ(VarianceRatio(rule, {10, 6000}), 0.95) << "dark image with lamps";
  EXPECT_DOUBLE_EQ(VarianceRatio(rule, {0, 0}), 0.3) << "black image";
}

TEST(AdaptiveThreshold, FixedIsFixed) {
  AdaptiveThresholdOptions options;
  options.fixed_ratio = 0.6;
  EXPECT_EQ(AdaptiveThreshold(options).Ratio({100, 1}), 0.6);
  EXPECT_EQ(AdaptiveThreshold(options).Ratio({10, 9000}), 0.6);
}

/// Matches of which the share `wrong` below `ratio` is 0 and above it is a half; nine in ten wrong
/// ones are seen to be wrong.
std::vector<RatedMatch> MatchesWrongFrom(double ratio, int count, int seed) {
  RandomEngine engine(seed);
  std::vector<RatedMatch> matches;
  for (int i = 0; i < count; ++i) {
    const double at = RandomUnit(engine);
    const bool is_wrong = at > ratio && RandomUnit(engine) < 0.5;
    matches.push_back({at, is_wrong && RandomUnit(engine) < 0.9});
  }
  return matches;
}

AdaptiveThresholdOptions FalseMatchOptions() {
  AdaptiveThresholdOptions options;
  options.rule = ThresholdRule::kFalseMatches;
  return options;
}

TEST(AdaptiveThreshold, FindsTheRatioThatGivesTheWantedPrecision) {
  AdaptiveThreshold threshold(FalseMatchOptions());
  EXPECT_EQ(threshold.Ratio({}), 0.8) << "before the first pair";
  threshold.Learn(MatchesWrongFrom(0.6, 20000, 1), 0.9);
  // (r - 0.6) / 2 = 0.05 r
  EXPECT_NEAR(threshold.Ratio({}), 0.3 / 0.45, 0.021);
}

TEST(AdaptiveThreshold, FollowsTheScene) {
  AdaptiveThreshold threshold(FalseMatchOptions());
  for (int pair = 0; pair < 30; ++pair) threshold.Learn(MatchesWrongFrom(0.8, 500, pair), 0.9);
  const double easy = threshold.Ratio({});
  threshold.Learn(MatchesWrongFrom(0.4, 500, 99), 0.9);
  EXPECT_GT(threshold.Ratio({}), 0.6) << "one pair does not turn it over";
  for (int pair = 0; pair < 30; ++pair) threshold.Learn(MatchesWrongFrom(0.4, 500, pair), 0.9);
  EXPECT_LT(threshold.Ratio({}), easy - 0.3);
}

TEST(AdaptiveThreshold, WhereAllAreRightLetsAllPassAndWhereAllAreWrongNearlyNone) {
  AdaptiveThreshold threshold(FalseMatchOptions());
  threshold.Learn(std::vector<RatedMatch>(100, {0.97, false}), 0.9);
  EXPECT_EQ(threshold.Ratio({}), 0.95);
  AdaptiveThreshold other(FalseMatchOptions());
  other.Learn(std::vector<RatedMatch>(100, {0.5, true}), 0.9);
  EXPECT_EQ(other.Ratio({}), 0.3);
}

TEST(AdaptiveThreshold, TooFewMatchesSayNothing) {
  AdaptiveThreshold threshold(FalseMatchOptions());
  threshold.Learn({{0.5, true}, {0.6, true}}, 0.9);
  threshold.Learn({}, 0.9);
  EXPECT_EQ(threshold.Ratio({}), 0.8);
}

TEST(AdaptiveThresholdOptions, CheckNamesTheBadKey) {
  AdaptiveThresholdOptions options;
  options.min_ratio = 0.99;
  EXPECT_THROW(AdaptiveThreshold{options}, std::invalid_argument);
  EXPECT_THROW(AdaptiveThreshold({}).Learn({}, 0), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
