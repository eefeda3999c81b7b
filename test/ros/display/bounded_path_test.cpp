#include "arfm_vo/ros/display/bounded_path.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

geometry_msgs::Pose At(double x) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  return pose;
}

TEST(BoundedPath, TakesPosesThatKeepTheirDistance) {
  BoundedPath path({0.5, 100});
  EXPECT_TRUE(path.Add({}, At(0)));
  EXPECT_FALSE(path.Add({}, At(0.4)));
  EXPECT_TRUE(path.Add({}, At(0.5)));
  EXPECT_EQ(path.path().poses.size(), 2u);
}

TEST(BoundedPath, StaysBoundedAndReachesFromStartToEnd) {
  BoundedPath path({0.1, 50});
  for (int i = 0; i <= 10000; ++i) path.Add({}, At(0.1 * i + 1e-9 * i));
  const auto& poses = path.path().poses;
  EXPECT_LE(poses.size(), 50u);
  EXPECT_GE(poses.size(), 25u);
  EXPECT_EQ(poses.front().pose.position.x, 0);
  const double spacing_m = poses[1].pose.position.x - poses[0].pose.position.x;
  EXPECT_GE(spacing_m, 1000.0 / 50);  // poses lie evenly
  EXPECT_LE(spacing_m, 1000.0 / 25 + 0.1);
  EXPECT_GT(poses.back().pose.position.x, 1000 - 2 * spacing_m);
}

TEST(BoundedPath, ClearsToItsFirstSpacing) {
  BoundedPath path({1, 2});
  for (int i = 0; i < 100; ++i) path.Add({}, At(i));
  path.Clear();
  path.Add({}, At(0));
  EXPECT_TRUE(path.Add({}, At(1)));
}

}  // namespace
}  // namespace arfm_vo
