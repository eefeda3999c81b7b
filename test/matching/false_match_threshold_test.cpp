#include "experiments/false_match_threshold.h"

#include <gtest/gtest.h>

#include "arfm_vo/base/random.h"

namespace arfm_vo {
namespace {

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

TEST(FalseMatchThreshold, FindsTheRatioThatGivesTheWantedPrecision) {
  FalseMatchThreshold threshold;
  EXPECT_EQ(threshold.Ratio(), 0.8) << "before the first pair";
  threshold.Learn(MatchesWrongFrom(0.6, 20000, 1), 0.9);
  // (r - 0.6) / 2 = 0.05 r
  EXPECT_NEAR(threshold.Ratio(), 0.3 / 0.45, 0.021);
}

TEST(FalseMatchThreshold, FollowsTheScene) {
  FalseMatchThreshold threshold;
  for (int pair = 0; pair < 30; ++pair) threshold.Learn(MatchesWrongFrom(0.8, 500, pair), 0.9);
  const double easy = threshold.Ratio();
  threshold.Learn(MatchesWrongFrom(0.4, 500, 99), 0.9);
  EXPECT_GT(threshold.Ratio(), 0.6) << "one pair does not turn it over";
  for (int pair = 0; pair < 30; ++pair) threshold.Learn(MatchesWrongFrom(0.4, 500, pair), 0.9);
  EXPECT_LT(threshold.Ratio(), easy - 0.3);
}

TEST(FalseMatchThreshold, WhereAllAreRightLetsAllPassAndWhereAllAreWrongNearlyNone) {
  FalseMatchThreshold threshold;
  threshold.Learn(std::vector<RatedMatch>(100, {0.97, false}), 0.9);
  EXPECT_EQ(threshold.Ratio(), 0.95);
  FalseMatchThreshold other;
  other.Learn(std::vector<RatedMatch>(100, {0.5, true}), 0.9);
  EXPECT_EQ(other.Ratio(), 0.3);
}

TEST(FalseMatchThreshold, TooFewMatchesSayNothing) {
  FalseMatchThreshold threshold;
  threshold.Learn({{0.5, true}, {0.6, true}}, 0.9);
  threshold.Learn({}, 0.9);
  EXPECT_EQ(threshold.Ratio(), 0.8);
}

}  // namespace
}  // namespace arfm_vo
