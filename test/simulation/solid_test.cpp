#include "arfm_vo/simulation/solid.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arfm_vo {
namespace {

TEST(Solid, UnitSphereIsEnteredAtItsNearSide) {
  const Solid sphere;
  const SolidHit hit = sphere.Intersect({{-5, 0, 0}, {2, 0, 0}}, 0, 100);
  EXPECT_NEAR(hit.parameter, 2, 1e-12);  // x = -1
  EXPECT_NEAR((hit.normal - Eigen::Vector3d(-1, 0, 0)).norm(), 0, 1e-12);
  EXPECT_TRUE(std::isinf(sphere.Intersect({{-5, 1.01, 0}, {2, 0, 0}}, 0, 100).parameter));
}

TEST(Solid, PlaneCutsTheSphere) {
  Solid dome;
  dome.planes.emplace_back(-1, 0, 0, 0.5);  // x >= -0.5
  const SolidHit hit = dome.Intersect({{-5, 0, 0}, {1, 0, 0}}, 0, 100);
  EXPECT_NEAR(hit.parameter, 4.5, 1e-12);
  EXPECT_EQ(hit.face, 1);
}

TEST(Solid, TurnedBoxIsMetAtItsEdge) {
  const Rigid3 pose(Eigen::Quaterniond(Eigen::AngleAxisd(M_PI / 4, Eigen::Vector3d::UnitZ())),
                    Eigen::Vector3d(10, 0, 0));
  const Solid box = MakeBox(pose, {1, 1, 2});
  EXPECT_NEAR(box.Intersect({{0, 1e-9, 0}, {1, 0, 0}}, 0, 100).parameter, 10 - std::sqrt(2), 1e-6);
  EXPECT_TRUE(std::isinf(box.Intersect({{0, 0, 2.01}, {1, 0, 0}}, 0, 100).parameter));
  EXPECT_NEAR(box.Intersect({{10, 0, 9}, {0, 0, -1}}, 0, 100).parameter, 7, 1e-9);
}

TEST(Solid, BlocksOnlyWhatLiesAhead) {
  const Solid sphere;
  EXPECT_TRUE(sphere.Blocks({{-5, 0.5, 0}, {1, 0, 0}}));
  EXPECT_FALSE(sphere.Blocks({{5, 0.5, 0}, {1, 0, 0}}));
  EXPECT_FALSE(sphere.Blocks({{-5, 1.5, 0}, {1, 0, 0}}));
}

}  // namespace
}  // namespace arfm_vo
