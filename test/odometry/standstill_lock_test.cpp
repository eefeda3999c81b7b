#include "arfm_vo/odometry/standstill_lock.h"

#include <gtest/gtest.h>

#include <random>

namespace arfm_vo {
namespace {

constexpr double kSigmaPx = 0.1, kSigmaM = 0.002, kSigmaRad = 1e-4;

/// 100 points seen with noise; the first `num_moving` of them shifted by `shift_px`.
LandmarkObservations See(double shift_px, int num_moving, std::mt19937& engine) {
  std::normal_distribution<double> noise(0, kSigmaPx);
  LandmarkObservations observations(100);
  for (int i = 0; i < 100; ++i) {
    observations[i].landmark = i;
    observations[i].pixels << 5 * i + noise(engine), 3 * i + noise(engine), 0, 0;
    if (i < num_moving) observations[i].pixels.x() += shift_px;
  }
  return observations;
}

PoseEstimate PoseAt(double x_m, std::mt19937& engine) {
  std::normal_distribution<double> noise(0, 1);
  PoseEstimate pose;
  pose.status = PoseStatus::kTracked;
  pose.camera_from_world.translation =
      Eigen::Vector3d(x_m, 0, 0) +
      kSigmaM * Eigen::Vector3d(noise(engine), noise(engine), noise(engine));
  pose.camera_from_world.rotation =
      ExpSO3(kSigmaRad * Eigen::Vector3d(noise(engine), noise(engine), noise(engine)));
  pose.covariance.diagonal() << Eigen::Vector3d::Constant(kSigmaRad * kSigmaRad),
      Eigen::Vector3d::Constant(kSigmaM * kSigmaM);
  return pose;
}

/// A lock that has seen one picture.
class StandstillLockTest : public testing::Test {
 protected:
  StandstillLockTest() { EXPECT_FALSE(lock_.Hold(first_, See(0, 0, engine_))); }

  std::mt19937 engine_{1};
  StandstillLock lock_{StandstillOptions()};
  const PoseEstimate first_ = PoseAt(0, engine_);
};

TEST_F(StandstillLockTest, HoldsThePoseOfAParkedRoverExactly) {
  for (int i = 0; i < 1000; ++i) {
    const auto held = lock_.Hold(PoseAt(0, engine_), See(0, 0, engine_));
    ASSERT_TRUE(held) << "frame " << i;
    EXPECT_EQ((held->translation - first_.camera_from_world.translation).norm(), 0);
  }
}

TEST_F(StandstillLockTest, HoldsWhileAShadowMovesOverAThirdOfThePoints) {
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE(lock_.Hold(PoseAt(0, engine_), See(2.0 * i, 33, engine_))) << "frame " << i;
}

TEST_F(StandstillLockTest, LetsGoWhenThePointsMove) {
  EXPECT_FALSE(lock_.Hold(PoseAt(0, engine_), See(2, 100, engine_)));
}

TEST_F(StandstillLockTest, LosesNothingOfACreepingMotion) {
  double held_at = 0;
  for (int i = 1; i <= 200; ++i) {
    const double truth = 0.001 * i;  // 1 mm a frame: less than the noise
    const auto held = lock_.Hold(PoseAt(truth, engine_), See(0, 0, engine_));
    if (!held) held_at = truth;
    EXPECT_LT(truth - held_at, 0.03);
  }
}

TEST_F(StandstillLockTest, HoldsNothingAtFirstOrWhenSwitchedOff) {
  StandstillOptions options;
  options.enabled = false;
  StandstillLock lock(options);
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(lock.Hold(PoseAt(0, engine_), See(0, 0, engine_)));
}

}  // namespace
}  // namespace arfm_vo
