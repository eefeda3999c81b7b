#include "arfm_vo/driving/way_home.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/refusal.h"

namespace arfm_vo {
namespace {

using Path = std::vector<RoverPose>;

/// Adds poses each 0.4 m or less from the last one to `to`.
void DriveTo(const RoverPose& to, Path& path) {
  const RoverPose from = path.back();
  const double dx_m = to.x_m - from.x_m, dy_m = to.y_m - from.y_m;
  const int num_steps = static_cast<int>(std::ceil(std::hypot(dx_m, dy_m) / 0.4));
  for (int i = 1; i <= num_steps; ++i) {
    const double share = static_cast<double>(i) / num_steps;
    path.push_back({from.x_m + share * dx_m, from.y_m + share * dy_m, std::atan2(dy_m, dx_m)});
  }
}

std::string Refusal(const Path& driven, const RoverPose& rover) {
  return RefusalOf([&] { FindWayHome(driven, rover); });
}

TEST(WayHome, LeadsBackRoundTheCornerAndTurnsToTheFirstHeading) {
  Path driven{{0, 0, 0.3}};
  DriveTo({8, 0, 0}, driven);
  DriveTo({8, 6, 0}, driven);
  const Route route = FindWayHome(driven, {8.02, 6, 0});
  ASSERT_EQ(route.size(), 2u);
  EXPECT_NEAR(route[0].x_m, 8, 0.1);
  EXPECT_NEAR(route[0].y_m, 0, 0.1);
  EXPECT_FALSE(route[0].heading_rad);
  EXPECT_EQ(route[1].x_m, 0);
  EXPECT_EQ(route[1].y_m, 0);
  EXPECT_EQ(route[1].heading_rad, 0.3);
}

TEST(WayHome, StaysWithinATenthOfAMetreOfTheWayOfACurve) {
  Path driven;
  for (int i = 0; i <= 40; ++i)
    driven.push_back({5 * std::sin(0.1 * i), 5 - 5 * std::cos(0.1 * i), 0});
  const Route route = FindWayHome(driven, driven.back());
  EXPECT_LT(route.size(), 20u);
  RoverPose from = driven.back();
  for (const Waypoint& to : route) {
    EXPECT_NEAR(std::hypot(to.x_m, to.y_m - 5), 5, 1e-9);
    EXPECT_NEAR(std::hypot((from.x_m + to.x_m) / 2, (from.y_m + to.y_m) / 2 - 5), 5, 0.1);
    from = {to.x_m, to.y_m, 0};
  }
}

TEST(WayHome, LeavesOutALoopWhereThePathMeetsItself) {
  Path driven{{0, 0, 0}};
  DriveTo({10, 0, 0}, driven);
  DriveTo({10, 5, 0}, driven);
  DriveTo({5, 5, 0}, driven);
  DriveTo({5, -5, 0}, driven);
  for (const Waypoint& waypoint : FindWayHome(driven, driven.back())) EXPECT_LE(waypoint.x_m, 5.4);
}

TEST(WayHome, GoesOnInThePathOfAnEarlierDriveThatWasFoundAgain) {
  Path driven{{0, 0, 0}};
  DriveTo({6, 0, 0}, driven);
  driven.push_back({3, 0.3, 1});  // the next drive wakes up here
  DriveTo({3, 7, 0}, driven);
  const Route route = FindWayHome(driven, driven.back());
  EXPECT_EQ(route.back().x_m, 0);
  for (const Waypoint& waypoint : route) EXPECT_LE(waypoint.x_m, 3.4);
}

TEST(WayHome, AtHomeTheRoverTurnsOnly) {
  const Route route = FindWayHome({{1, 2, 0.5}}, {1.01, 2, 0});
  ASSERT_EQ(route.size(), 1u);
  EXPECT_EQ(route[0].heading_rad, 0.5);
}

TEST(WayHome, OverGroundThatWasNotDrivenThereIsNone) {
  Path driven{{0, 0, 0}};
  EXPECT_EQ(Refusal({}, {}), "way home: no path is known");
  DriveTo({6, 0, 0}, driven);
  EXPECT_EQ(Refusal(driven, {3, 4, 0}), "way home: the rover stands 4.0 m beside the path");
  driven.push_back({12, 0, 0});  // carried there
  EXPECT_EQ(Refusal(driven, {12, 0, 0}), "way home: the path has a gap of more than 2 m");
}

}  // namespace
}  // namespace arfm_vo
