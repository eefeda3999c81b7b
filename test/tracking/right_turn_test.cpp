#include "arfm_vo/tracking/right_turn.h"

#include <gtest/gtest.h>

#include <random>

#include "arfm_vo/geometry/linear_algebra.h"

namespace arfm_vo {
namespace {

/// Known points 3 to 30 m ahead, and a pair that sees them from `camera_from_world_`.
class RightTurnTest : public ::testing::Test {
 protected:
  RightTurnTest() {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> u(20, 620), v(20, 460), depth(3, 30);
    for (int i = 0; i < 300; ++i) {
      const double z = depth(random);
      Landmark landmark;
      landmark.id = i;
      landmark.x_in_world << z * (u(random) - kCamera.cx) / kCamera.fx,
          z * (v(random) - kCamera.cy) / kCamera.fy, z;
      landmark.covariance = 1e-4 * z * z * Eigen::Matrix3d::Identity();
      landmarks_.push_back(landmark);
    }
  }

  /// What a pair tells where the right camera stands so, with a pose that is a little off.
  std::optional<RightTurn> AgainstMap(const Eigen::Vector3d& turn_rad, double noise_px = 0.2,
                                      int seed = 2) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0, noise_px);
    const StereoCorrection turned{CorrectionBelief::ByTurn(kCamera) * turn_rad};
    std::vector<const Landmark*> seen;
    LandmarkObservations observations;
    for (const Landmark& landmark : landmarks_) {
      LandmarkObservation observation;
      observation.landmark = landmark.id;
      observation.pixels =
          ProjectStereo4(kCamera, turned, kPose * landmark.x_in_world).cast<float>();
      for (float& pixel : observation.pixels) pixel += static_cast<float>(noise(random));
      observation.has_right = landmark.id % 5 != 0;
      observation.sigma_px = 0.2;
      seen.push_back(&landmark);
      observations.push_back(observation);
    }
    const Rigid3 off(ExpSO3({1e-4, 2e-4, 0}), Eigen::Vector3d(0, 0, 0.02));
    return FindTurnAgainstMap(kCamera, {}, seen, observations, off * kPose);
  }

  std::optional<RightTurn> Since(const Eigen::Vector3d& before_rad, const Eigen::Vector3d& now_rad,
                                 double noise_px = 0.2) {
    return FindTurnSince(*AgainstMap(before_rad, noise_px, 2), *AgainstMap(now_rad, noise_px, 3));
  }

  const StereoCamera kCamera{500, 500, 320, 240, 0.3, 640, 480};
  const Rigid3 kPose{ExpSO3({0.01, -0.02, 0.005}), Eigen::Vector3d(0.1, 0, -0.5)};
  std::vector<Landmark> landmarks_;
};

TEST_F(RightTurnTest, FindsNoneWhereThereIsNone) {
  EXPECT_FALSE(Since({0, 0, 0}, {0, 0, 0}));
  EXPECT_FALSE(Since({0, 0, 0}, {0, 1e-4, 0})) << "0.05 px";
  EXPECT_FALSE(Since({0, 0, 0}, {0, 0, 0}, 0.6)) << "noise that is not expected";
  EXPECT_FALSE(Since({3e-3, 3e-3, 3e-3}, {3e-3, 3e-3, 3e-3})) << "it has always stood so";
}

TEST_F(RightTurnTest, FindsATurnAboutEachAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    const Eigen::Vector3d turn_rad = 3e-3 * Eigen::Vector3d::Unit(axis);
    const auto found = Since({1e-3, 0, 0}, turn_rad + Eigen::Vector3d(1e-3, 0, 0));
    ASSERT_TRUE(found) << axis;
    const Eigen::Vector3d off = found->turn_rad - turn_rad;
    EXPECT_LT(off.norm(), 3e-4) << axis;
    EXPECT_LT(SquaredMahalanobis(off, found->covariance), 9) << axis;
  }
}

TEST_F(RightTurnTest, AFewPointsTellNothing) {
  landmarks_.resize(20);
  EXPECT_FALSE(AgainstMap({0, 3e-3, 0}));
}

}  // namespace
}  // namespace arfm_vo
