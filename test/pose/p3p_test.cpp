#include "pose/p3p.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "pose/pose_scene.h"

namespace arfm_vo {
namespace {

using ThreeRays = Eigen::Matrix<double, 2, 3>;

TEST(P3p, FindsThePoseThatSeesThePoints) {
  RandomEngine engine(1);
  for (int trial = 0; trial < 1000; ++trial) {
    const Rigid3 truth = RandomPose(engine, 1, 5);
    Eigen::Matrix3d points;
    ThreeRays rays;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d x = RandomVisiblePoint(engine, 2, 40);
      points.col(i) = truth.Inverse() * x;
      rays.col(i) = x.head<2>() / x.z();
    }
    const std::vector<Rigid3> poses = SolveP3p(points, rays);
    EXPECT_LE(poses.size(), 4u);
    EXPECT_TRUE(std::any_of(poses.begin(), poses.end(), [&](const Rigid3& pose) {
      return StepBetween(truth, pose).norm() < 1e-4;
    })) << trial;
    for (const Rigid3& pose : poses) {
      for (int i = 0; i < 3; ++i) {
        const Eigen::Vector3d x = pose * Eigen::Vector3d(points.col(i));
        EXPECT_GT(x.z(), 0);
        EXPECT_LT((x.head<2>() / x.z() - rays.col(i)).norm(), 1e-6) << trial;
      }
    }
  }
}

TEST(P3p, FindsNothingByPointsOnALine) {
  Eigen::Matrix3d points;
  points << 0, 1, 2, 0, 1, 2, 5, 6, 7;
  EXPECT_TRUE(SolveP3p(points, points.colwise().hnormalized()).empty());
  EXPECT_TRUE(SolveP3p(Eigen::Matrix3d::Ones(), ThreeRays::Zero()).empty());
}

TEST(P3p, FindsNothingThatIsNotFinite) {
  Eigen::Matrix3d points = Eigen::Matrix3d::Identity();
  points(0, 0) = std::nan("");
  EXPECT_TRUE(SolveP3p(points, ThreeRays::Zero()).empty());
}

}  // namespace
}  // namespace arfm_vo
