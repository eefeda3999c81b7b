#include "arfm_vo/driving/goal_limits.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

GoalLimitsOptions LShapedFence() {
  GoalLimitsOptions options;
  options.fence_m = {-1, -1, 10, -1, 10, 1, 1, 1, 1, 10, -1, 10};
  return options;
}

TEST(GoalLimits, AGoalOutsideThemIsRefusedAndTheReasonNamed) {
  const GoalLimits open{GoalLimitsOptions{}}, fenced(LShapedFence());
  const struct {
    const GoalLimits& limits;
    Route route;
    RoverPose rover;
    const char* flaw;
  } rows[] = {
      {open, {{30, 40, {}}}, {}, ""},
      {open, {{30, 41, {}}}, {}, "it is 50.8 m away, farther than 50.0 m"},
      {open, {{1, 0, {}}, {60, 0, {}}}, {}, "waypoint 1 is 60.0 m away, farther than 50.0 m"},
      {open, {{100, 65, {}}}, {90, 20, 0}, ""},
      {open, {{0, 0, {}}}, {-30, -41, 0}, "it is 50.8 m away, farther than 50.0 m"},
      {open, Route(100), {}, ""},
      {open, Route(101), {}, "it has more than 100 waypoints"},
      {fenced, {{9, 0, {}}}, {}, ""},
      {fenced, {{5, 5, {}}}, {}, "it is outside the fence"},
      {fenced, {{0, 9, {}}}, {9, 0, 0}, "the way to it leaves the fence"},
      {fenced, {{0, 0, {}}, {0, 9, {}}}, {9, 0, 0}, ""}};
  for (const auto& [limits, route, rover, flaw] : rows)
    EXPECT_EQ(limits.FindFlaw(route, rover), flaw);
  EXPECT_TRUE(fenced.IsInsideFence(0, 9));
  EXPECT_FALSE(fenced.IsInsideFence(2, 2));
}

TEST(GoalLimits, EdgesOfAFenceMayRunAskew) {
  GoalLimitsOptions options;
  options.fence_m = {0, 0, 10, 10, 0, 20, 4, 10};  // an arrow head that points along +x
  const GoalLimits limits(options);
  const RoverPose below{2.5, 5, 0};
  EXPECT_TRUE(limits.IsInsideFence(2.5, 5));
  EXPECT_FALSE(limits.IsInsideFence(1.5, 5));
  EXPECT_FALSE(limits.IsInsideFence(5.5, 5));
  EXPECT_EQ(limits.FindFlaw({{6, 10, {}}}, below), "");
  EXPECT_EQ(limits.FindFlaw({{6, 10, {}}, {2.5, 15, {}}}, below), "");
  EXPECT_EQ(limits.FindFlaw({{2.5, 15, {}}}, below), "the way to it leaves the fence");
}

TEST(GoalLimits, AFenceOfTwoCornersOrThatCrossesItselfIsRefused) {
  GoalLimitsOptions options;
  for (const auto& fence_m : {std::vector<double>{0, 0, 1, 1}, {0, 0, 1, 1, 1, 0, 0, 1}}) {
    options.fence_m = fence_m;
    EXPECT_THROW(GoalLimits{options}, std::invalid_argument);
  }
}

TEST(GoalLimits, AGoalUnderTheRoverAndAWayBackStayInsideTheFence) {
  const GoalLimits limits(LShapedFence());
  EXPECT_EQ(limits.FindFlaw({{0, 0, {}}}, {}), "");
  EXPECT_EQ(limits.FindFlaw({{9, 0, {}}, {0, 0, {}}, {0, 9, {}}}, {}), "");
}

}  // namespace
}  // namespace arfm_vo
