#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "base/refusal.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

double WorstPoseError(const CorridorScene& scene, const BundleResult& result) {
  double worst = 0;
  for (size_t i = 0; i < scene.camera_from_world.size(); ++i) {
    worst = std::max(worst,
                     StepBetween(scene.camera_from_world[i], result.camera_from_world[i]).norm());
  }
  return worst;
}

double WorstPointError(const CorridorScene& scene, const BundleResult& result) {
  double worst = 0;
  for (size_t i = 0; i < scene.points.size(); ++i)
    worst = std::max(worst, (result.points[i] - scene.points[i]).norm());
  return worst;
}

BundleOptions ExactOptions(BundleSolver solver) {
  BundleOptions options;
  options.solver = solver;
  options.max_iterations = 50;
  options.function_tolerance = 1e-12;
  return options;
}

TEST(BundleAdjustment, ReturnsToTheTruthWithoutNoise) {
  CorridorOptions corridor;
  corridor.noise_px = 0;
  const CorridorScene scene = MakeCorridor(corridor);
  BundleOptions newton = ExactOptions(BundleSolver::kCeres);
  newton.strategy = StepStrategy::kGaussNewton;
  for (const BundleOptions& options :
       {ExactOptions(BundleSolver::kOwn), ExactOptions(BundleSolver::kCeres), newton}) {
    const BundleResult result = AdjustBundle(scene.problem, options);
    EXPECT_EQ(result.status, BundleStatus::kConverged);
    EXPECT_LT(WorstPoseError(scene, result), 1e-6);
    EXPECT_LT(WorstPointError(scene, result), 1e-4);
    EXPECT_GT(result.initial_cost, 1e3);
    EXPECT_LT(result.final_cost, 2);  // pixels are rounded, by 0.015 sigma
  }
  newton.solver = BundleSolver::kOwn;
  EXPECT_THROW(AdjustBundle(scene.problem, newton), std::invalid_argument);
}

TEST(BundleAdjustment, OwnSolverAgreesWithCeres) {
  for (const LossKind loss : {LossKind::kSquared, LossKind::kHuber, LossKind::kCauchy}) {
    CorridorOptions corridor;
    corridor.outlier_share = 0.05;
    CorridorScene scene = MakeCorridor(corridor);
    for (size_t i = 0; i < scene.problem.observations.size(); i += 7)
      scene.problem.observations[i].has_right = false;
    if (loss != LossKind::kHuber) scene.problem.correction_prior = CorrectionBelief::Isotropic(0.5);
    BundleOptions options = ExactOptions(BundleSolver::kOwn);
    options.loss = loss;
    const BundleResult own = AdjustBundle(scene.problem, options);
    options.solver = BundleSolver::kCeres;
    const BundleResult ceres = AdjustBundle(scene.problem, options);
    EXPECT_NEAR(own.initial_cost, ceres.initial_cost, 1e-9 * own.initial_cost);
    EXPECT_NEAR(own.final_cost, ceres.final_cost, 1e-7 * own.final_cost);
    for (size_t i = 0; i < own.camera_from_world.size(); ++i)
      EXPECT_LT(StepBetween(own.camera_from_world[i], ceres.camera_from_world[i]).norm(), 1e-5);
    EXPECT_LT((own.correction.coefficients_px - ceres.correction.coefficients_px).norm(), 1e-4);
    EXPECT_EQ(own.correction.IsZero(), loss == LossKind::kHuber);
    EXPECT_EQ(own.is_inlier, ceres.is_inlier);
  }
}

TEST(BundleAdjustment, SparseSolverAgreesWithCeresOnALongPath) {
  CorridorOptions corridor;
  corridor.num_poses = 60;
  corridor.num_points = 1500;
  CorridorScene scene = MakeCorridor(corridor);
  scene.problem.correction_prior = CorrectionBelief::Isotropic(0.5);
  PoseConstraint loop;  // ties the last pose to the third, as a closed loop does
  loop.first = 2;
  loop.second = 59;
  loop.second_from_first = scene.camera_from_world[59] * scene.camera_from_world[2].Inverse();
  loop.information.setIdentity();
  loop.information.diagonal() << 1e6, 1e6, 1e6, 1e4, 1e4, 1e4;
  scene.problem.constraints.push_back(loop);
  const BundleResult own = AdjustBundle(scene.problem, ExactOptions(BundleSolver::kOwn));
  const BundleResult ceres = AdjustBundle(scene.problem, ExactOptions(BundleSolver::kCeres));
  EXPECT_NEAR(own.final_cost, ceres.final_cost, 1e-7 * own.final_cost);
  EXPECT_LT(StepBetween(own.camera_from_world[59], ceres.camera_from_world[59]).norm(), 1e-4);
  EXPECT_LT(WorstPoseError(scene, own), 0.2);
}

TEST(BundleAdjustment, AConstraintPullsAsItsInformationSays) {
  // One free pose, drawn by two constraints only: the mean, weighted 3 to 1.
  BundleProblem problem;
  problem.camera = kBundleCamera;
  problem.camera_from_world.resize(2);
  problem.pose_is_fixed = {1, 0};
  for (const double weight : {3.0, 1.0}) {
    PoseConstraint constraint;
    constraint.first = 0;
    constraint.second = 1;
    constraint.second_from_first.translation = {0, 0, weight == 3 ? 1.0 : 2.0};
    constraint.information = weight * Eigen::Matrix<double, 6, 6>::Identity();
    problem.constraints.push_back(constraint);
  }
  for (const BundleSolver solver : {BundleSolver::kOwn, BundleSolver::kCeres}) {
    const BundleResult result = AdjustBundle(problem, ExactOptions(solver));
    EXPECT_NEAR(result.camera_from_world[1].translation.z(), 1.25, 1e-6);
    EXPECT_NEAR(result.final_cost, 3 * 0.25 * 0.25 + 0.75 * 0.75, 1e-6);
  }
}

TEST(BundleAdjustment, LeavesFixedPosesWhereTheyAre) {
  const CorridorScene scene = MakeCorridor({});
  const BundleResult result = AdjustBundle(scene.problem, {});
  for (const int i : {0, 1})
    EXPECT_EQ(result.camera_from_world[i].Matrix(), scene.problem.camera_from_world[i].Matrix());
  EXPECT_NE(result.camera_from_world[2].Matrix(), scene.problem.camera_from_world[2].Matrix());
}

TEST(BundleAdjustment, StandsTenPercentGrossOutliersAndNamesThem) {
  CorridorOptions corridor;
  corridor.outlier_share = 0.1;
  const CorridorScene scene = MakeCorridor(corridor);
  corridor.outlier_share = 0;
  const double clean_error =
      WorstPoseError(scene, AdjustBundle(MakeCorridor(corridor).problem, {}));
  for (const LossKind loss : {LossKind::kHuber, LossKind::kCauchy}) {
    BundleOptions options;
    options.loss = loss;
    const BundleResult result = AdjustBundle(scene.problem, options);
    EXPECT_LT(WorstPoseError(scene, result), std::max(3 * clean_error, 0.05));
    int num_missed = 0, num_false = 0, num_outliers = 0;
    for (size_t i = 0; i < scene.is_outlier.size(); ++i) {
      num_outliers += scene.is_outlier[i];
      num_missed += scene.is_outlier[i] && result.is_inlier[i];
      num_false += !scene.is_outlier[i] && !result.is_inlier[i];
    }
    EXPECT_LT(num_missed, 0.05 * num_outliers);
    EXPECT_LT(num_false, 0.05 * scene.is_outlier.size());
  }
}

TEST(BundleAdjustment, HasFiniteCovariancesWhereTheLossGivesUpAllObservations) {
  CorridorScene scene = MakeCorridor({});
  for (BundleObservation& observation : scene.problem.observations) observation.sigma_px /= 100;
  BundleOptions options;
  options.loss = LossKind::kTukey;
  options.with_point_covariance = true;
  const BundleResult result = AdjustBundle(scene.problem, options);
  EXPECT_TRUE(std::isfinite(result.covariance_factor));
  for (const Eigen::Matrix3d& covariance : result.point_covariances)
    EXPECT_TRUE(covariance.allFinite());
}

TEST(BundleAdjustment, MeasuresTheScaleOfTheResiduals) {
  CorridorScene scene = MakeCorridor({});
  for (BundleObservation& observation : scene.problem.observations) observation.sigma_px /= 2;
  EXPECT_NEAR(AdjustBundle(scene.problem, {}).scale, 2, 0.15);
}

TEST(BundleAdjustment, PointCovarianceIsThatOfStereoForAPointSeenOnce) {
  BundleProblem problem;
  problem.camera = kBundleCamera;
  problem.camera_from_world.resize(1);
  problem.pose_is_fixed = {1};
  problem.points = {{0.27, 0, 10}};  // half way between the cameras
  BundleObservation observation{
      {ProjectStereo4(kBundleCamera, {}, problem.points[0]).cast<float>(), true, 0.5}, 0, 0};
  problem.observations = {observation};
  BundleOptions options;
  options.with_point_covariance = true;
  const BundleResult result = AdjustBundle(problem, options);
  ASSERT_EQ(result.point_covariances.size(), 1u);
  const Eigen::Matrix3d& covariance = result.point_covariances[0];
  // Disparity has the variance 2 sigma^2, and Z = b f / d; v is measured twice.
  const double depth_sigma = 10 * 10 / (0.54 * 707) * 0.5 * std::sqrt(2.0);
  EXPECT_NEAR(covariance(2, 2), depth_sigma * depth_sigma, 1e-6);
  EXPECT_NEAR(covariance(1, 1), std::pow(0.5 * 10 / 707, 2) / 2, 1e-9);
  EXPECT_EQ(result.is_inlier, std::vector<char>(1, 1));
}

TEST(BundleAdjustment, ReportsProgressAndCanBeCancelled) {
  const CorridorScene scene = MakeCorridor({});
  for (const BundleSolver solver : {BundleSolver::kOwn, BundleSolver::kCeres}) {
    std::vector<BundleProgress> reports;
    const BundleResult result =
        AdjustBundle(scene.problem, ExactOptions(solver), [&](const BundleProgress& progress) {
          reports.push_back(progress);
          return reports.size() < 3;
        });
    EXPECT_EQ(result.status, BundleStatus::kCancelled);
    ASSERT_EQ(reports.size(), 3u);
    EXPECT_EQ(reports[0].iteration, 0);
    EXPECT_EQ(reports[2].iteration, 2);
    EXPECT_LT(reports[2].cost, reports[0].cost);
    EXPECT_LT(result.final_cost, result.initial_cost);
  }
}

TEST(BundleAdjustment, StopsWhereIterationsOrTimeRunOut) {
  const CorridorScene scene = MakeCorridor({});
  BundleOptions options;
  options.max_iterations = 1;
  EXPECT_EQ(AdjustBundle(scene.problem, options).status, BundleStatus::kNotConverged);
  options = {};
  options.max_time_s = 1e-9;
  const BundleResult result = AdjustBundle(scene.problem, options);
  EXPECT_EQ(result.status, BundleStatus::kNotConverged);
  EXPECT_LE(result.num_iterations, 1);
}

TEST(BundleAdjustment, LeavesPointsAndPosesThatNothingPlaces) {
  CorridorScene scene = MakeCorridor({});
  BundleProblem& problem = scene.problem;
  problem.points[5] = {0, 0, -50};                           // behind the camera
  const int once = static_cast<int>(problem.points.size());  // seen by the left camera alone
  problem.points.emplace_back(1, 0, 12);
  problem.observations.push_back({{{600, 200, 0, 0}, false, 0.5}, 3, once});
  problem.camera_from_world.emplace_back();  // nothing ties it to a fixed one
  problem.pose_is_fixed.push_back(0);
  for (const BundleSolver solver : {BundleSolver::kOwn, BundleSolver::kCeres}) {
    const BundleResult result = AdjustBundle(problem, ExactOptions(solver));
    for (const int point : {5, once}) EXPECT_EQ(result.points[point], problem.points[point]);
    EXPECT_EQ(result.point_is_used[once], 0);
    EXPECT_EQ(result.is_inlier.back(), 0);
    EXPECT_EQ(result.camera_from_world.back().Matrix(), Rigid3().Matrix());
    EXPECT_NE(result.status, BundleStatus::kFailed);
    EXPECT_LT(WorstPoseError(scene, result), 0.1);
  }
}

TEST(BundleAdjustment, NamesWhatIsWrongWithTheProblem) {
  const BundleProblem good = MakeCorridor({}).problem;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto expect = [&](const char* complaint, const auto& spoil) {
    BundleProblem bad = good;
    spoil(bad);
    EXPECT_INVALID(AdjustBundle(bad, {}), complaint);
  };
  EXPECT_NO_THROW(AdjustBundle(good, {}));
  expect("no pose is fixed", [](auto& p) { p.pose_is_fixed.assign(p.pose_is_fixed.size(), 0); });
  expect("pose_is_fixed", [](auto& p) { p.pose_is_fixed.pop_back(); });
  expect("no observation", [](auto& p) { p.observations.clear(); });
  expect("observation 7: pose", [](auto& p) { p.observations[7].pose = 8; });
  expect("observation 7: pose", [](auto& p) { p.observations[7].pose = -1; });
  expect("observation 7: point", [](auto& p) { p.observations[7].point = 400; });
  expect("observation 7: pixels", [&](auto& p) { p.observations[7].pixels[2] = nan; });
  expect("observation 7: sigma_px", [](auto& p) { p.observations[7].sigma_px = 0; });
  expect("pose 3", [&](auto& p) { p.camera_from_world[3].translation.x() = nan; });
  expect("point 9", [&](auto& p) { p.points[9].x() = nan; });
  expect("baseline", [](auto& p) { p.camera.baseline_m = 0; });
  expect("correction_prior", [](auto& p) { p.correction_prior = CorrectionBelief(); });
  expect("correction is not finite", [&](auto& p) { p.correction.coefficients_px[4] = nan; });
  expect("constraint 0: ties", [](auto& p) { p.constraints.resize(1); });
}

TEST(BundleAdjustment, OptionsNameTheBadKey) {
  BundleOptions options;
  EXPECT_NO_THROW(options.Check());
  options.max_time_share = 0;
  EXPECT_INVALID(options.Check(), "max_time_share");
}

TEST(BundleAdjustment, SleepingInBetweenChangesNothing) {
  const CorridorScene scene = MakeCorridor({});
  BundleOptions options;
  const BundleResult at_once = AdjustBundle(scene.problem, options);
  options.max_time_share = 0.5;
  const BundleResult paced = AdjustBundle(scene.problem, options);
  EXPECT_EQ(paced.final_cost, at_once.final_cost);
}

}  // namespace
}  // namespace arfm_vo
