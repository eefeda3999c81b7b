#include "arfm_vo/pose/false_alarms.h"

#include <gtest/gtest.h>

#include <cmath>

#include "arfm_vo/pose/pose_estimator.h"
#include "pose/pose_scene.h"

namespace arfm_vo {
namespace {

TEST(FalseAlarms, CountTheSetsThatAgreeByChance) {
  // Of 6 matches 5 can be chosen in 6 ways, and of these a sample of three in 10; two more agree.
  EXPECT_NEAR(LogFalseAlarms(6, 5, std::log(0.1)), std::log(6 * 10 * 0.1 * 0.1), 1e-12);
  EXPECT_NEAR(LogFalseAlarms(4, 4, std::log(0.01)), std::log(4 * 0.01), 1e-12);
}

TEST(FalseAlarms, TheBestNumberOfPointsCounts) {
  const double few = std::log(1e-3);
  // Of 5 matches all agree: one set with ten samples, and one or two more that it may hold.
  EXPECT_NEAR(LogFalseAlarms(5, std::vector<double>(5, few)), std::log(10 * 2) + 2 * few, 1e-9);
  std::vector<double> with_poor(5, few);
  with_poor.resize(20, 0);
  EXPECT_NEAR(LogFalseAlarms(40, with_poor), LogFalseAlarms(40, std::vector<double>(5, few)), 1e-9);
  EXPECT_GT(LogFalseAlarms(40, {few, few, few}), 0) << "a sample agrees with its own pose";
}

TEST(FalseAlarms, FewMatchesThatAllAgreeAreEnoughAndTheSameNumberOfManyIsNot) {
  for (const int num_agreeing : {6, 10}) {
    const std::vector<double> agreeing(num_agreeing, std::log(0.003));
    EXPECT_LT(LogFalseAlarms(num_agreeing, agreeing), kMaxLogFalseAlarms);
    EXPECT_GT(LogFalseAlarms(100 * num_agreeing, agreeing), kMaxLogFalseAlarms);
  }
}

TEST(FalseAlarms, ThePlaceOfAMatchIsAsWideAsItWasLookedFor) {
  // 2 px off, where it may be 40 px off: a 400th of the circle.
  EXPECT_NEAR(LogChance(2, 4, 1, 40), std::log(1 / 400.), 1e-12);
  EXPECT_NEAR(LogChance(3, 4, 1, 40), std::log(1 / 8000.), 1e-12);
  EXPECT_NEAR(LogChance(2, 1, 16, 40), LogChance(2, 4, 1, 40), 1e-12);
  EXPECT_EQ(LogChance(2, 9, 1e8, 40), 0) << "anywhere";
}

TEST(FalseAlarms, PointsWhosePlaceIsHardlyKnownTellNothing) {
  RandomEngine engine(3);
  auto observations = MakeObservations(Rigid3(), 12, 0.5, engine);
  const std::vector<char> all(observations.size(), 1);
  EXPECT_FALSE(AgreesByChance(kSceneCamera, observations, all, Rigid3()));
  for (PointObservation& observation : observations) {
    observation.pixels += 12 * RandomNormal3(engine);
    const double sigma_m = 20 * observation.x_in_world.z() / kSceneCamera.fx;
    observation.x_covariance = sigma_m * sigma_m * Eigen::Matrix3d::Identity();
  }
  EXPECT_TRUE(AgreesByChance(kSceneCamera, observations, all, Rigid3()));
}

/// Gives each of the first observations the pixels of the next.
void Mismatch(size_t count, std::vector<PointObservation>& observations) {
  const Eigen::Vector3d first = observations[0].pixels;
  for (size_t i = 0; i + 1 < count; ++i) observations[i].pixels = observations[i + 1].pixels;
  observations[count - 1].pixels = first;
}

TEST(FalseAlarms, FewMatchesThatAgreeAreAPoseAndManyThatDoNotAreNone) {
  RandomEngine engine(15);
  for (int i = 0; i < 20; ++i) {
    const Rigid3 truth = RandomPose(engine, 1, 5);
    auto observations = MakeObservations(truth, 15, 0.5, engine);
    Mismatch(5, observations);
    const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, std::nullopt, {});
    ASSERT_TRUE(estimate.IsTracked());
    EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 0.2);
    observations = MakeObservations(truth, 60, 0.5, engine);
    Mismatch(60, observations);
    EXPECT_FALSE(EstimatePose(kSceneCamera, observations, std::nullopt, {}).HasPose());
  }
}

}  // namespace
}  // namespace arfm_vo
