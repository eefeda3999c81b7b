#include "arfm_vo/simulation/drive_path.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

TEST(SamplePath, StraightStepsAreEven) {
  const PlanarPath path = SamplePath({1, 2, M_PI / 2}, {{0.35, 0}, {10, 0}}, 0.1, 0.1, 8);
  ASSERT_EQ(path.size(), 8u);
  for (int i = 0; i < 8; ++i)
    EXPECT_NEAR((PositionOf(path[i]) - Eigen::Vector2d(1, 2 + 0.1 * i)).norm(), 0, 1e-12) << i;
}

TEST(SamplePath, QuarterCircleEndsWhereItShould) {
  // Radius 2 m, to the left from the origin along +x: ends at (2, 2) heading +y.
  const PlanarPath path = SamplePath({}, {{M_PI, M_PI / 2}}, M_PI / 20, 1, 21);
  EXPECT_NEAR((PositionOf(path.back()) - Eigen::Vector2d(2, 2)).norm(), 0, 1e-9);
  EXPECT_NEAR(path.back().heading_rad, M_PI / 2, 1e-9);
  EXPECT_NEAR(path[10].x_m, 2 * std::sin(M_PI / 4), 1e-9);
}

TEST(SamplePath, TurnInPlaceKeepsThePosition) {
  const PlanarPath path = SamplePath({}, {{0.2, 0}, {0, -0.3}, {1, 0}}, 0.1, 0.1, 7);
  for (int i = 2; i <= 5; ++i) {
    EXPECT_NEAR(path[i].x_m, 0.2, 1e-12) << i;
    EXPECT_NEAR(path[i].heading_rad, -0.1 * (i - 2), 1e-12) << i;
  }
  EXPECT_NEAR((PositionOf(path[6]) - PositionOf(path[5])).norm(), 0.1, 1e-12);
}

TEST(SamplePath, RefusesAPathThatGoesNowhere) {
  EXPECT_THROW(SamplePath({}, {{0, 0}}, 0.1, 0.1, 3), std::invalid_argument);
  EXPECT_THROW(SamplePath({}, {}, 0.1, 0.1, 3), std::invalid_argument);
  EXPECT_THROW(SamplePath({}, {{1, 0}}, 0, 0.1, 3), std::invalid_argument);
}

TEST(BaseFromLeftCamera, LooksAheadAndDown) {
  RoverShape shape;
  shape.camera_tilt_deg = 30;
  const Rigid3 base_from_camera = BaseFromLeftCamera(shape);
  const Eigen::Vector3d axis = base_from_camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR((axis - Eigen::Vector3d(std::cos(M_PI / 6), 0, -0.5)).norm(), 0, 1e-12);
  const Eigen::Vector3d right = base_from_camera.rotation * Eigen::Vector3d::UnitX();
  EXPECT_NEAR((right - Eigen::Vector3d(0, -1, 0)).norm(), 0, 1e-12);
  EXPECT_NEAR((base_from_camera.translation - Eigen::Vector3d(0.2, 0.1, 1)).norm(), 0, 1e-12);
}

TEST(BaseFromLeftCamera, PanTurnsTheHeadToTheLeft) {
  RoverShape shape;
  shape.camera_tilt_deg = 0;
  const Rigid3 base_from_camera = BaseFromLeftCamera(shape, M_PI / 2);
  const Eigen::Vector3d axis = base_from_camera.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR((axis - Eigen::Vector3d::UnitY()).norm(), 0, 1e-12);
  EXPECT_NEAR((base_from_camera.translation - Eigen::Vector3d(0.1, 0, 1)).norm(), 0, 1e-12);
}

TEST(PlaceRover, LevelGroundGivesALevelRover) {
  TerrainOptions options;
  options.side_m = 25.6;
  options.relief_m = options.hills_m = 0;
  options.rocks.density_per_m2 = 0;
  const Terrain terrain(options);
  const Rigid3 world_from_base = PlaceRover(terrain, {1, -2, 0.7}, {});
  EXPECT_NEAR((world_from_base.translation - Eigen::Vector3d(1, -2, 0)).norm(), 0, 1e-9);
  EXPECT_NEAR(LogSO3(world_from_base.rotation).z(), 0.7, 1e-9);
  EXPECT_NEAR(world_from_base.Angle(), 0.7, 1e-9);
}

}  // namespace
}  // namespace arfm_vo
