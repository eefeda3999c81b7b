#include "arfm_vo/ros/messages/display_messages.h"

#include <gtest/gtest.h>
#include <sensor_msgs/point_cloud2_iterator.h>

namespace arfm_vo {
namespace {

geometry_msgs::Pose At(double x) {
  geometry_msgs::Pose pose;
  pose.position.x = x;
  return pose;
}

TEST(BoundedPath, TakesPosesThatKeepTheirDistance) {
  BoundedPath path(0.5, 100);
  EXPECT_TRUE(path.Add({}, At(0)));
  EXPECT_FALSE(path.Add({}, At(0.4)));
  EXPECT_TRUE(path.Add({}, At(0.5)));
  EXPECT_EQ(path.path().poses.size(), 2u);
}

TEST(BoundedPath, StaysBoundedAndReachesFromStartToEnd) {
  BoundedPath path(0.1, 50);
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
  BoundedPath path(1, 2);
  for (int i = 0; i < 100; ++i) path.Add({}, At(i));
  path.Clear();
  path.Add({}, At(0));
  EXPECT_TRUE(path.Add({}, At(1)));
}

TEST(LandmarkCloud, HoldsPlacesDepthsAndColours) {
  const auto cloud = MakeLandmarkCloud({{{1, 2, 3}, 2}, {{4, 5, 6}, 50}});
  EXPECT_EQ(cloud.width * cloud.height, 2u);
  sensor_msgs::PointCloud2ConstIterator<float> z(cloud, "z"), depth(cloud, "depth");
  sensor_msgs::PointCloud2ConstIterator<uint8_t> bgr(cloud, "rgb");
  EXPECT_EQ(*z, 3);
  EXPECT_EQ(*depth, 2);
  EXPECT_GT(bgr[0], 200) << "blue";
  EXPECT_LT(bgr[2], 100);
  ++z, ++depth, ++bgr;
  EXPECT_EQ(*z, 6);
  EXPECT_EQ(*depth, 50);
  EXPECT_GT(bgr[2], 200) << "red";
  EXPECT_LT(bgr[0], 100);
}

TEST(LandmarkCloud, MayBeEmpty) { EXPECT_EQ(MakeLandmarkCloud({}).width, 0u); }

}  // namespace
}  // namespace arfm_vo
