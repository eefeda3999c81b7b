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

TEST(StandstillLock, HoldsThePoseOfAParkedRoverExactly) {
  std::mt19937 engine(1);
  StandstillLock lock({});
  const PoseEstimate first = PoseAt(0, engine);
  EXPECT_FALSE(lock.Hold(first, See(0, 0, engine)));
  for (int i = 0; i < 1000; ++i) {
    const auto held = lock.Hold(PoseAt(0, engine), See(0, 0, engine));
    ASSERT_TRUE(held) << "frame " << i;
    EXPECT_EQ((held->translation - first.camera_from_world.translation).norm(), 0);
  }
}

TEST(StandstillLock, HoldsWhileAShadowMovesOverAThirdOfThePoints) {
  std::mt19937 engine(2);
  StandstillLock lock({});
  lock.Hold(PoseAt(0, engine), See(0, 0, engine));
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(lock.Hold(PoseAt(0, engine), See(2.0 * i, 33, engine))) << "frame " << i;
  }
}

TEST(StandstillLock, LetsGoWhenThePointsMove) {
  std::mt19937 engine(3);
  StandstillLock lock({});
  lock.Hold(PoseAt(0, engine), See(0, 0, engine));
  EXPECT_FALSE(lock.Hold(PoseAt(0, engine), See(2, 100, engine)));
}

TEST(StandstillLock, LosesNothingOfACreepingMotion) {
  std::mt19937 engine(4);
  StandstillLock lock({});
  lock.Hold(PoseAt(0, engine), See(0, 0, engine));
  double held_at = 0;
  for (int i = 1; i <= 200; ++i) {
    const double truth = 0.001 * i;  // 1 mm a frame: less than the noise
    const auto held = lock.Hold(PoseAt(truth, engine), See(0, 0, engine));
    if (!held) held_at = truth;
    EXPECT_LT(truth - held_at, 0.03);
  }
}

TEST(StandstillLock, HoldsNothingAtFirstOrWhenSwitchedOff) {
  std::mt19937 engine(5);
  StandstillOptions options;
  options.enabled = false;
  StandstillLock lock(options);
  EXPECT_FALSE(lock.Hold(PoseAt(0, engine), See(0, 0, engine)));
  EXPECT_FALSE(lock.Hold(PoseAt(0, engine), See(0, 0, engine)));
}

}  // namespace
}  // namespace arfm_vo
