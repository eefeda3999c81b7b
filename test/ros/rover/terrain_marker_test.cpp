#include <gtest/gtest.h>

#include <algorithm>

#include "arfm_vo/ros/rover/simulator_node.h"

namespace arfm_vo {
namespace {

Eigen::Vector3d ToVector(const geometry_msgs::Point& point) { return {point.x, point.y, point.z}; }

TEST(TerrainMarker, ItsTrianglesLieOnTheGroundAndFaceTheSky) {
  TerrainOptions options;
  options.side_m = 102.4;
  const Terrain terrain(options);
  Rigid3 map_from_world;
  map_from_world.translation.z() = -0.7;
  const visualization_msgs::Marker marker = MakeTerrainMarker(terrain, map_from_world, "map");
  EXPECT_EQ(marker.header.frame_id, "map");
  EXPECT_EQ(marker.pose.position.z, -0.7);
  EXPECT_EQ(marker.scale.x, 1);  // rviz warns of 0
  EXPECT_EQ(marker.scale.y, 1);
  EXPECT_EQ(marker.scale.z, 1);
  EXPECT_EQ(marker.color.a, 1);
  ASSERT_EQ(marker.points.size(), marker.colors.size());
  ASSERT_EQ(marker.points.size() % 3, 0u);
  double area_m2 = 0, lowest_m = 1e9, highest_m = -1e9;
  for (size_t i = 0; i < marker.points.size(); i += 3) {
    const Eigen::Vector3d a = ToVector(marker.points[i]);
    const Eigen::Vector3d normal =
        (ToVector(marker.points[i + 1]) - a).cross(ToVector(marker.points[i + 2]) - a);
    ASSERT_GT(normal.z(), 0);
    area_m2 += normal.z() / 2;
    ASSERT_NEAR(a.z(), terrain.Height(a.x(), a.y()) - 0.05, 1e-12);
    lowest_m = std::min(lowest_m, a.z());
    highest_m = std::max(highest_m, a.z());
  }
  EXPECT_NEAR(area_m2, 60 * 60, 1e-6);
  EXPECT_GT(highest_m - lowest_m, 0.3);
  for (const auto& color : marker.colors) ASSERT_LE(std::max({color.r, color.g, color.b}), 1);
}

}  // namespace
}  // namespace arfm_vo
