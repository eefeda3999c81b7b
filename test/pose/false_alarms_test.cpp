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

TEST(FalseAlarms, FewMatchesThatAllAgreeAreEnoughAndTheSameNumberOfManyIsNot) {
  EXPECT_GT(LeastAgreeing(0), 0);
  EXPECT_GT(LeastAgreeing(4), 4) << "even all of them agree by chance";
  EXPECT_EQ(LeastAgreeing(5), 5);
  int last = 0;
  for (const int num_matches : {5, 15, 30, 100, 300, 1000}) {
    const int least = LeastAgreeing(num_matches);
    EXPECT_GT(least, last);
    EXPECT_LE(LogFalseAlarms(num_matches, least, std::log(0.003)), std::log(1e-4));
    EXPECT_GT(LogFalseAlarms(num_matches, least - 1, std::log(0.003)), std::log(1e-4));
    last = least;
  }
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
