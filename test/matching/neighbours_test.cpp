#include "arfm_vo/matching/neighbours.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(Neighbours, AddKeepsTheTwoNearest) {
  Neighbours neighbours;
  EXPECT_FLOAT_EQ(neighbours.Ratio(), 1);
  neighbours.Add(7, 0.5f);
  EXPECT_FLOAT_EQ(neighbours.Ratio(), 0);
  neighbours.Add(3, 0.25f);
  neighbours.Add(4, 1.0f);
  neighbours.Add(5, 0.25f);
  EXPECT_EQ(neighbours.nearest, 3);
  EXPECT_FLOAT_EQ(neighbours.squared_distance, 0.25f);
  EXPECT_FLOAT_EQ(neighbours.second_squared_distance, 0.25f);
}

TEST(Neighbours, RatioIsOfDistancesNotOfTheirSquares) {
  const Neighbours neighbours{0, 0.01f, 0.04f};
  EXPECT_NEAR(neighbours.Ratio(), 0.5, 1e-4);
}

/// Two first keypoints want second 0; it prefers first 1.
const TwoWayNeighbours kContested{{{0, 0.04f, 1.0f}, {0, 0.01f, 0.04f}, {-1}},
                                  {{1, 0.01f, 0.04f}, {0, 0.5f, 0.6f}}};

TEST(SelectMatches, CrossCheckKeepsMutualNeighboursOnly) {
  const Matches matches = SelectMatches(kContested, 1);
  ASSERT_EQ(matches.size(), 1u);
  EXPECT_EQ(matches[0].first, 1);
  EXPECT_EQ(matches[0].second, 0);
  EXPECT_FLOAT_EQ(matches[0].distance, 0.1f);
}

TEST(SelectMatches, ALoneCandidateMustBeNear) {
  const TwoWayNeighbours near{{{0, 0.4f}}, {{0, 0.4f}}}, far{{{0, 0.9f}}, {{0, 0.9f}}};
  EXPECT_EQ(SelectMatches(near, 0.8).size(), 1u);
  EXPECT_TRUE(SelectMatches(far, 0.8).empty());  // its ratio, 0, says nothing
}

TEST(SelectMatches, RatioThresholdApplies) {
  EXPECT_EQ(SelectMatches(kContested, 0.6).size(), 1u);
  EXPECT_EQ(SelectMatches(kContested, 0.4).size(), 0u);
}

TEST(SelectMatches, NothingComesOfNothing) { EXPECT_TRUE(SelectMatches({}, 1).empty()); }

}  // namespace
}  // namespace arfm_vo
