#include "arfm_vo/pose/pose_estimator.h"

#include <gtest/gtest.h>

#include <limits>

#include "base/number_spoiler.h"
#include "pose/pose_scene.h"

namespace arfm_vo {
namespace {

/// Gives the first `count` observations pixels that have nothing to do with their points.
void SpoilPixels(int count, RandomEngine& engine, std::vector<PointObservation>& observations) {
  for (int i = 0; i < count; ++i) {
    observations[i].pixels = kSceneCamera.ProjectStereo(RandomVisiblePoint(engine, 4, 40));
  }
}

/// A camera that sees what stands still and a group of points that moved on its own.
struct TwoGroups {
  Rigid3 truth;
  Rigid3 wrong;                                ///< by the group that moved
  std::vector<PointObservation> observations;  ///< those that stand still come first
};

TwoGroups MakeTwoGroups(int num_still, int num_moving, const Eigen::Vector3d& motion,
                        RandomEngine& engine) {
  TwoGroups scene;
  scene.truth = scene.wrong = RandomPose(engine, 1, 5);
  scene.wrong.translation += motion;
  scene.observations = MakeObservations(scene.truth, num_still, 0.5, engine);
  const auto moving = MakeObservations(scene.wrong, num_moving, 0.5, engine);
  scene.observations.insert(scene.observations.end(), moving.begin(), moving.end());
  return scene;
}

TEST(PoseEstimator, IsExactWithoutNoiseOrPrediction) {
  RandomEngine engine(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Rigid3 truth = RandomPose(engine, 1, 5);
    const auto observations = MakeObservations(truth, 40, 0, engine);
    const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, std::nullopt, {});
    ASSERT_TRUE(estimate.IsTracked());
    EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 1e-6);
    EXPECT_EQ(estimate.num_inliers, 40);
  }
}

TEST(PoseEstimator, StandsSixtyPercentOutliers) {
  RandomEngine engine(2);
  for (int trial = 0; trial < 20; ++trial) {
    const Rigid3 truth = RandomPose(engine, 1, 5);
    auto observations = MakeObservations(truth, 300, 0.5, engine);
    SpoilPixels(180, engine, observations);
    std::vector<char> is_inlier;
    const PoseEstimate estimate =
        EstimatePose(kSceneCamera, observations, std::nullopt, {}, &is_inlier);
    ASSERT_TRUE(estimate.IsTracked());
    EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 0.06);
    EXPECT_GE(estimate.num_inliers, 110);
    EXPECT_LE(estimate.num_inliers, 124);
    ASSERT_EQ(is_inlier.size(), 300u);
    EXPECT_EQ(std::count(is_inlier.begin(), is_inlier.end(), 1), estimate.num_inliers);
  }
}

TEST(PoseEstimator, DoesNotBelieveAWrongPrediction) {
  RandomEngine engine(3);
  const Rigid3 truth = RandomPose(engine, 1, 5);
  const auto observations = MakeObservations(truth, 100, 0.5, engine);
  Rigid3 wrong = truth;
  wrong.translation += Eigen::Vector3d(1, 0, 2);
  const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, wrong, {});
  ASSERT_TRUE(estimate.IsTracked());
  EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 0.06);
}

/// Another vehicle that fills 45 % of the view and moves exactly as was predicted.
TEST(PoseEstimator, AMinorityThatFitsThePredictionDoesNotWin) {
  RandomEngine engine(8);
  for (int trial = 0; trial < 10; ++trial) {
    const auto [truth, wrong, observations] = MakeTwoGroups(220, 180, {1, 0, 2}, engine);
    const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, wrong, {});
    ASSERT_EQ(estimate.status, PoseStatus::kTracked);
    EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 0.06);
    ASSERT_TRUE(estimate.rival);
    EXPECT_LT(StepBetween(wrong, *estimate.rival).norm(), 0.1);
  }
}

TEST(PoseEstimator, PointsThatAgreedBeforeOutvoteMoreThatDidNot) {
  RandomEngine engine(11);
  auto [truth, wrong, observations] = MakeTwoGroups(100, 250, {1, 0, 2}, engine);
  EXPECT_GT(StepBetween(
                truth, EstimatePose(kSceneCamera, observations, std::nullopt, {}).camera_from_world)
                .norm(),
            1);
  for (int i = 0; i < 100; ++i) observations[i].votes = 10;
  const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, std::nullopt, {});
  ASSERT_TRUE(estimate.IsTracked());
  EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 0.1);
  std::vector<char> agrees;
  const PoseEstimate wary = EstimatePose(kSceneCamera, observations, std::nullopt,
                                         PoseEstimatorOptions().Wary(), &agrees);
  ASSERT_TRUE(wary.rival);
  EXPECT_LT(StepBetween(wrong, *wary.rival).norm(), 0.1);
  EXPECT_NEAR(std::count(agrees.begin(), agrees.end(), kAgreesWithRival), 250, 10);
}

TEST(PoseEstimator, TheUsualMotionIsLikelierThanAnUnusualOne) {
  PredictedPose predicted{Rigid3()};
  Rigid3 other;
  other.translation.x() = 0.3;
  EXPECT_EQ(predicted.LogOdds(other), 0) << "nothing is known of the motion before";
  predicted.sigma_shift_m = 0.1;
  predicted.sigma_turn_rad = 0.01;
  EXPECT_GT(predicted.LogOdds(Rigid3()), 0);
  EXPECT_LT(predicted.LogOdds(other), 0);
  other.translation.x() = 1e6;
  EXPECT_GT(predicted.LogOdds(other), -8) << "anything may happen now and then";
}

TEST(PoseEstimator, APoseThatTheMotionDoesNotAllowNeedsFourTimesTheVotes) {
  for (const int num_moving : {150, 600}) {
    RandomEngine engine(12);
    const auto [truth, wrong, observations] = MakeTwoGroups(100, num_moving, {1, 0, 2}, engine);
    PredictedPose predicted(truth);
    predicted.max_shift_m = 0.5;
    predicted.max_turn_rad = 0.1;
    const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, predicted, {});
    ASSERT_TRUE(estimate.HasPose());
    const bool is_object = num_moving > 400;
    EXPECT_LT(StepBetween(is_object ? wrong : truth, estimate.camera_from_world).norm(), 0.1);
  }
}

/// The refinement of a prediction wanders off to where points lie between two groups.
TEST(PoseEstimator, AMajorityForThePredictionItselfIsNotGivenToItsRefinement) {
  int num_right = 0;
  for (int seed = 0; seed < 10; ++seed) {
    RandomEngine engine(seed);
    auto [truth, wrong, observations] = MakeTwoGroups(100, 300, {0.1, 0, 0.2}, engine);
    for (int i = 0; i < 100; ++i) observations[i].votes = 4;
    const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, truth, {});
    num_right += StepBetween(truth, estimate.camera_from_world).norm() < 0.08;
  }
  EXPECT_EQ(num_right, 10);
}

/// One sample of three would hardly be without outliers.
TEST(PoseEstimator, AMajorityNearThePredictionNeedsNoSamples) {
  RandomEngine engine(9);
  const Rigid3 truth = RandomPose(engine, 1, 5);
  auto observations = MakeObservations(truth, 300, 0.5, engine);
  SpoilPixels(120, engine, observations);
  PoseEstimatorOptions options;
  options.ransac.max_iterations = options.ransac.min_iterations = 1;
  Rigid3 near = truth;
  near.translation += Eigen::Vector3d(0.05, 0, 0.1);
  const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, near, options);
  ASSERT_TRUE(estimate.IsTracked());
  EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 0.06);
  EXPECT_GE(estimate.num_inliers, 170);
}

TEST(PoseEstimator, PassesOverAPredictionThatIsNotFinite) {
  RandomEngine engine(4);
  const Rigid3 truth = RandomPose(engine, 1, 5);
  const auto observations = MakeObservations(truth, 100, 0.5, engine);
  Rigid3 nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(EstimatePose(kSceneCamera, observations, nowhere, {}).IsTracked());
}

TEST(PoseEstimator, AGoodPredictionFindsWhatSamplesCannot) {
  RandomEngine engine(5);
  const Rigid3 truth = RandomPose(engine, 1, 5);
  auto observations = MakeObservations(truth, 400, 0.5, engine);
  SpoilPixels(360, engine, observations);
  PoseEstimatorOptions options;
  options.ransac.max_iterations = 10;
  options.min_inlier_share = 0.05;
  EXPECT_FALSE(EstimatePose(kSceneCamera, observations, std::nullopt, options).IsTracked());
  EXPECT_TRUE(EstimatePose(kSceneCamera, observations, truth, options).IsTracked());
}

TEST(PoseEstimator, KeepsPointsOfWideSpreadThatMovedAsTheirCovarianceSays) {
  RandomEngine engine(6);
  auto observations = MakeObservations({}, 100, 0.5, engine);
  for (int i = 0; i < 50; ++i) {  // 10 % of depth along the ray of a camera 3 m to the left
    const Eigen::Vector3d ray = observations[i].x_in_world + Eigen::Vector3d(3, 0, 0);
    observations[i].x_covariance = 0.01 * ray * ray.transpose();
    observations[i].x_in_world += 0.1 * RandomNormal(engine) * ray;
  }
  const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, std::nullopt, {});
  ASSERT_TRUE(estimate.IsTracked());
  EXPECT_GE(estimate.num_inliers, 95);
}

/// A smaller group of exact points that moved: who does not weigh errors by where points may lie
/// counts few votes for the others.
TEST(PoseEstimator, PointsOfWideSpreadVote) {
  RandomEngine engine(16);
  auto [truth, wrong, observations] = MakeTwoGroups(120, 60, {1, 0, 2}, engine);
  for (int i = 0; i < 120; ++i) {  // 3 % of depth
    const Eigen::Vector3d ray = truth.rotation.conjugate() * (truth * observations[i].x_in_world);
    observations[i].x_covariance = 9e-4 * ray * ray.transpose();
    observations[i].x_in_world += 0.03 * RandomNormal(engine) * ray;
  }
  const PoseEstimate estimate = EstimatePose(kSceneCamera, observations, wrong, {});
  ASSERT_TRUE(estimate.HasPose());
  EXPECT_LT(StepBetween(truth, estimate.camera_from_world).norm(), 0.2);
}

TEST(PoseEstimator, SaysTooFewMatches) {
  RandomEngine engine(8);
  std::vector<char> is_inlier;
  const auto observations = MakeObservations({}, 4, 0, engine);
  const PoseEstimate estimate =
      EstimatePose(kSceneCamera, observations, std::nullopt, {}, &is_inlier);
  EXPECT_EQ(estimate.status, PoseStatus::kTooFewMatches);
  EXPECT_EQ(estimate.num_matches, 4);
  EXPECT_EQ(is_inlier, std::vector<char>(4, 0));
  EXPECT_EQ(EstimatePose(kSceneCamera, {}, std::nullopt, {}).status, PoseStatus::kTooFewMatches);
}

TEST(PoseEstimator, SaysNoConsensusForRandomPixels) {
  RandomEngine engine(9);
  auto observations = MakeObservations({}, 100, 0, engine);
  SpoilPixels(100, engine, observations);
  EXPECT_EQ(EstimatePose(kSceneCamera, observations, Rigid3(), {}).status,
            PoseStatus::kNoConsensus);
}

TEST(PoseEstimator, SaysNoConsensusForOnePointManyTimes) {
  RandomEngine engine(10);
  const std::vector<PointObservation> observations(50, MakeObservations({}, 1, 0, engine)[0]);
  EXPECT_EQ(EstimatePose(kSceneCamera, observations, std::nullopt, {}).status,
            PoseStatus::kNoConsensus);
}

TEST(PoseEstimator, RefusesObservationsThatAreNotFinite) {
  RandomEngine engine(11);
  auto observations = MakeObservations({}, 50, 0, engine);
  observations[7].pixels.y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_INVALID(EstimatePose(kSceneCamera, observations, std::nullopt, {}), "observation 7");
}

TEST(PoseEstimator, EachNumberOfItsOptionsIsChecked) {
  ExpectNumbersAreChecked<PoseEstimatorOptions>([](auto& options) { options.Check(); }, {"seed"});
}

TEST(PoseStatus, HasNamesForPeople) {
  EXPECT_STREQ(ToString(PoseStatus::kTooFewMatches), "too few matches");
  EXPECT_STREQ(ToString(PoseStatus::kNoConsensus), "no consensus");
}

}  // namespace
}  // namespace arfm_vo
