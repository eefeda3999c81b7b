#include "arfm_vo/pose/pose_refinement.h"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <limits>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "arfm_vo/pose/reprojection.h"
#include "pose/pose_scene.h"

namespace arfm_vo {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

Rigid3 Disturb(const Rigid3& pose, RandomEngine& engine) {
  Vector6d step;
  step << 0.02 * RandomNormal3(engine), 0.3 * RandomNormal3(engine);
  return BoxPlus(pose, step);
}

/// Moves each point as a stereo pair at `seen_from` would have measured it, with that covariance.
void MeasurePoints(const Rigid3& seen_from, double sigma_px, RandomEngine& engine,
                   std::vector<PointObservation>& observations) {
  for (PointObservation& observation : observations) {
    const Eigen::Vector3d x = seen_from * observation.x_in_world;
    const Eigen::Matrix3d spread = sigma_px * ProjectionJacobian(kSceneCamera, x).inverse();
    const Eigen::Matrix3d covariance = spread * spread.transpose();
    const Eigen::Matrix3d world_from_camera = seen_from.RotationMatrix().transpose();
    observation.x_covariance = world_from_camera * covariance * world_from_camera.transpose();
    observation.x_in_world += world_from_camera * (spread * RandomNormal3(engine));
  }
}

/// 95 % bounds of the mean of `count` chi-square variables of 6 degrees of freedom.
void ExpectHonest(double mean_nees, int count) {
  EXPECT_GT(mean_nees, ChiSquareQuantile(6 * count, 0.025) / count);
  EXPECT_LT(mean_nees, ChiSquareQuantile(6 * count, 0.975) / count);
}

TEST(PoseRefinement, IsExactWithoutNoise) {
  RandomEngine engine(2);
  for (const StepKind step : {StepKind::kGaussNewton, StepKind::kLevenbergMarquardt}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Rigid3 truth = RandomPose(engine, 1, 5);
      auto observations = MakeObservations(truth, 30, 0, engine);
      for (int i = 0; i < 10; ++i) observations[i].has_right = false;
      PoseRefinementOptions options;
      options.step = step;
      const PoseRefinement result =
          RefinePose(kSceneCamera, observations, Disturb(truth, engine), options);
      ASSERT_EQ(result.status, RefinementStatus::kConverged);
      EXPECT_LT(StepBetween(truth, result.camera_from_world).norm(), 1e-6);
      EXPECT_EQ(result.num_inliers, 30);
    }
  }
}

TEST(PoseRefinement, FindsThePoseFromLeftPixelsAlone) {
  RandomEngine engine(3);
  const Rigid3 truth = RandomPose(engine, 1, 5);
  auto observations = MakeObservations(truth, 30, 0, engine);
  for (auto& observation : observations) {
    observation.has_right = false;
    observation.pixels.z() = std::numeric_limits<double>::quiet_NaN();
  }
  const PoseRefinement result = RefinePose(kSceneCamera, observations, Disturb(truth, engine), {});
  ASSERT_EQ(result.status, RefinementStatus::kConverged);
  EXPECT_LT(StepBetween(truth, result.camera_from_world).norm(), 1e-6);
}

TEST(PoseRefinement, LeavesOutliersOut) {
  RandomEngine engine(4);
  for (const LossKind loss : {LossKind::kHuber, LossKind::kCauchy, LossKind::kTukey}) {
    const Rigid3 truth = RandomPose(engine, 1, 5);
    auto observations = MakeObservations(truth, 200, 0.5, engine);
    for (int i = 0; i < 60; ++i) observations[i].pixels += 40 * RandomNormal3(engine);
    Vector6d step;
    step << 0.002, -0.003, 0.001, 0.02, 0.03, -0.02;
    PoseRefinementOptions options;
    options.loss = loss;
    const PoseRefinement result =
        RefinePose(kSceneCamera, observations, BoxPlus(truth, step), options);
    ASSERT_EQ(result.status, RefinementStatus::kConverged);
    EXPECT_LT(StepBetween(truth, result.camera_from_world).norm(), 0.02);
    int num_outliers_kept = 0, num_inliers_kept = 0;
    for (int i = 0; i < 200; ++i) {
      (i < 60 ? num_outliers_kept : num_inliers_kept) += result.is_inlier[i];
    }
    EXPECT_LE(num_outliers_kept, 3);
    EXPECT_GE(num_inliers_kept, 132);
  }
}

TEST(PoseRefinement, NewPointsThatMovedTogetherDoNotTakeThePoseAlong) {
  constexpr int kNumProven = 60;
  RandomEngine engine(21);
  const Rigid3 truth = RandomPose(engine, 1, 5);
  Rigid3 by_object = truth;
  by_object.translation.z() += 0.2;
  std::vector<PointObservation> observations = MakeObservations(truth, kNumProven, 0.5, engine);
  for (const auto& moved : MakeObservations(by_object, 3 * kNumProven, 0.5, engine)) {
    observations.push_back(moved);
  }
  const auto error_m = [&] {
    const PoseRefinement refined = RefinePose(kSceneCamera, observations, truth, {});
    EXPECT_EQ(refined.status, RefinementStatus::kConverged);
    return (refined.camera_from_world.translation - truth.translation).norm();
  };
  EXPECT_GT(error_m(), 0.1);
  for (size_t i = kNumProven; i < observations.size(); ++i) observations[i].is_proven = false;
  EXPECT_LT(error_m(), 0.05);
}

TEST(PoseRefinement, MeasuresTheScaleOfTheResiduals) {
  RandomEngine engine(5);
  const Rigid3 truth = RandomPose(engine, 1, 5);
  auto observations = MakeObservations(truth, 500, 0.8, engine);
  for (auto& observation : observations) observation.sigma_px = 0.4;  // too sure of itself
  const PoseRefinement result = RefinePose(kSceneCamera, observations, truth, {});
  ASSERT_EQ(result.status, RefinementStatus::kConverged);
  EXPECT_NEAR(result.scale, 2, 0.15);
  EXPECT_NEAR(result.rms_px, 0.8, 0.05);
}

TEST(PoseRefinement, CovarianceIsHonestForExactPoints) {
  RandomEngine engine(26);
  for (const LossKind loss :
       {LossKind::kSquared, LossKind::kHuber, LossKind::kCauchy, LossKind::kTukey}) {
    constexpr int kTrials = 400;
    double sum = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      const Rigid3 truth = RandomPose(engine, 1, 5);
      const auto observations = MakeObservations(truth, 100, 0.7, engine);
      PoseRefinementOptions options;
      options.loss = loss;
      options.loss_threshold_sigma = loss == LossKind::kTukey ? 4.7 : 2.4;
      const PoseRefinement result =
          RefinePose(kSceneCamera, observations, Disturb(truth, engine), options);
      ASSERT_EQ(result.status, RefinementStatus::kConverged);
      const Vector6d step = StepBetween(truth, result.camera_from_world);
      sum += SquaredMahalanobis(step, result.covariance);
    }
    SCOPED_TRACE(static_cast<int>(loss));
    ExpectHonest(sum / kTrials, kTrials);
  }
}

TEST(PoseRefinement, CovarianceIsHonestForMeasuredPoints) {
  RandomEngine engine(7);
  constexpr int kTrials = 400;
  double sum = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Rigid3 truth = RandomPose(engine, 1, 5);
    auto observations = MakeObservations(truth, 100, 0.7, engine);
    Vector6d motion;
    motion << 0.01 * RandomNormal3(engine), 0, 0, -1;
    const Rigid3 seen_from = BoxPlus(truth, motion);
    MeasurePoints(seen_from, 0.7, engine, observations);
    const PoseRefinement result =
        RefinePose(kSceneCamera, observations, Disturb(truth, engine), {});
    ASSERT_EQ(result.status, RefinementStatus::kConverged);
    const Vector6d step = StepBetween(truth, result.camera_from_world);
    sum += SquaredMahalanobis(step, result.covariance);
  }
  ExpectHonest(sum / kTrials, kTrials);
}

TEST(PoseRefinement, FourPointsAreEnough) {
  RandomEngine engine(12);
  for (const int count : {0, 3, 4}) {
    const auto observations = MakeObservations({}, count, 0, engine);
    EXPECT_EQ(RefinePose(kSceneCamera, observations, {}, {}).status,
              count < 4 ? RefinementStatus::kTooFewPoints : RefinementStatus::kConverged)
        << count;
  }
}

TEST(PoseRefinement, IteratesNoMoreWhereStepsChangeNothing) {
  RandomEngine engine(13);
  const auto observations = MakeObservations({}, 30, 0, engine);
  EXPECT_LE(RefinePose(kSceneCamera, observations, {}, {}).num_iterations, 3);
}

/// From so far off that a full step often raises the cost.
TEST(PoseRefinement, StepsThatRaiseTheCostAreShortenedOrEndTheSearch) {
  RandomEngine engine(14);
  int num_found[] = {0, 0};
  for (int trial = 0; trial < 100; ++trial) {
    const Rigid3 truth = RandomPose(engine, 1, 5);
    const auto observations = MakeObservations(truth, 30, 0, engine);
    Vector6d step;
    step << 0.7 * RandomNormal3(engine), 4 * RandomNormal3(engine);
    for (const StepKind kind : {StepKind::kGaussNewton, StepKind::kLevenbergMarquardt}) {
      PoseRefinementOptions options;
      options.step = kind;
      options.loss = LossKind::kSquared;
      const PoseRefinement result =
          RefinePose(kSceneCamera, observations, BoxPlus(truth, step), options);
      num_found[kind == StepKind::kLevenbergMarquardt] +=
          result.num_inliers == 30 && StepBetween(truth, result.camera_from_world).norm() < 1e-6;
    }
  }
  EXPECT_GT(num_found[1], num_found[0]);
}

TEST(PoseRefinement, SaysTooFewPointsWhereAllLieBehindTheCamera) {
  RandomEngine engine(9);
  const auto observations = MakeObservations({}, 30, 0, engine);
  const Rigid3 turned(ExpSO3({0, M_PI, 0}), Eigen::Vector3d(0, 0, 0));
  EXPECT_NE(RefinePose(kSceneCamera, observations, turned, {}).status,
            RefinementStatus::kConverged);
}

TEST(PoseRefinement, SaysRankDeficientForPointsOnALineAndOnePointManyTimes) {
  for (const double spread : {1, 0}) {
    std::vector<PointObservation> observations(10);
    for (int i = 0; i < 10; ++i) {
      observations[i].x_in_world =
          Eigen::Vector3d(0, 0, 10) + spread * i * Eigen::Vector3d(0.5, 0.3, 1);
      observations[i].pixels = kSceneCamera.ProjectStereo(observations[i].x_in_world);
    }
    EXPECT_EQ(RefinePose(kSceneCamera, observations, {}, {}).status,
              RefinementStatus::kRankDeficient)
        << spread;
  }
}

TEST(PoseRefinement, RefusesWrongUse) {
  RandomEngine engine(10);
  const auto good = MakeObservations({}, 20, 0, engine);
  auto bad = good;
  bad[3].pixels.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RefinePose(kSceneCamera, bad, {}, {}), std::invalid_argument);
  bad = good;
  bad[3].x_in_world.z() = std::numeric_limits<double>::infinity();
  EXPECT_THROW(RefinePose(kSceneCamera, bad, {}, {}), std::invalid_argument);
  bad = good;
  bad[3].sigma_px = 0;
  EXPECT_THROW(RefinePose(kSceneCamera, bad, {}, {}), std::invalid_argument);
  EXPECT_THROW(RefinePose(kSceneCamera, good, {}, {}, {1, 0, 1}), std::invalid_argument);
  Rigid3 nowhere;
  nowhere.translation.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(RefinePose(kSceneCamera, good, nowhere, {}), std::invalid_argument);
  PoseRefinementOptions options;
  options.max_rounds = 0;
  EXPECT_THROW(RefinePose(kSceneCamera, good, {}, options), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
