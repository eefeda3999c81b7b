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

}  // namespace
}  // namespace arfm_vo
