#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/pose/chi_square.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

/// The squared distance of an estimate from the truth in units of its stated covariance.
double SquaredDistance(const BundleResult& result, const Eigen::Vector3d& truth) {
  const Eigen::Vector3d error = result.correction.rotation - truth;
  return error.dot(result.correction_covariance.ldlt().solve(error));
}

BundleResult Calibrate(const CorridorOptions& corridor) {
  BundleProblem problem = MakeCorridor(corridor).problem;
  problem.correction_sigma_rad.setConstant(5e-3);
  return AdjustBundle(problem, {});
}

TEST(SelfCalibration, FindsTheTurnOfTheRightCameraFromNoisyImagesAlone) {
  CorridorOptions corridor;
  corridor.num_poses = 12;
  corridor.num_points = 800;
  corridor.num_fixed = 1;  // two would tell the scale
  corridor.correction.rotation.setConstant(4e-4);
  const BundleResult result = Calibrate(corridor);
  EXPECT_LT(SquaredDistance(result, corridor.correction.rotation), ChiSquareQuantile(3, 0.99));
  for (int axis = 0; axis < 3; ++axis) {
    const double sigma = std::sqrt(result.correction_covariance(axis, axis));
    EXPECT_LT(sigma, 4e-4 / 4) << "axis " << axis << " is not worth stating";
    EXPECT_NEAR(result.correction.rotation[axis], 4e-4, 4 * sigma) << axis;
  }
}

TEST(SelfCalibration, StatesAnHonestCovarianceWithAndWithoutATurn) {
  constexpr int kTrials = 120;
  for (const double turn : {0.0, 4e-4}) {
    double sum = 0;
    int num_significant = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      CorridorOptions corridor;
      corridor.num_points = 100;
      corridor.num_fixed = 1;  // two would tell the scale
      corridor.seed = 1000 + trial;
      corridor.correction.rotation.setConstant(turn);
      const BundleResult result = Calibrate(corridor);
      sum += SquaredDistance(result, corridor.correction.rotation);
      num_significant +=
          SquaredDistance(result, Eigen::Vector3d::Zero()) > ChiSquareQuantile(3, 0.99);
    }
    EXPECT_GT(sum, ChiSquareQuantile(3 * kTrials, 0.025)) << turn;
    EXPECT_LT(sum, ChiSquareQuantile(3 * kTrials, 0.975)) << turn;
    if (turn == 0) {
      EXPECT_LE(num_significant, 5);
    } else {
      EXPECT_GE(num_significant, kTrials * 9 / 10);
    }
  }
}

TEST(SelfCalibration, IgnoringATurnBiasesTheMotionAndFindingItDoesNot) {
  CorridorOptions corridor;
  corridor.num_poses = 12;
  corridor.num_points = 800;
  corridor.num_fixed = 1;
  corridor.correction.rotation = {0, 1e-3, 0};
  const CorridorScene scene = MakeCorridor(corridor);
  const double length = scene.camera_from_world.back().translation.norm();
  const auto length_error = [&](const BundleResult& result) {
    return std::abs(result.camera_from_world.back().translation.norm() / length - 1);
  };
  const double with = length_error(Calibrate(corridor));
  const double without = length_error(AdjustBundle(scene.problem, {}));
  EXPECT_GT(without, 0.005);
  EXPECT_LT(with, 0.002);
}

TEST(SelfCalibration, AFrozenAxisStaysWhereItStarts) {
  CorridorOptions corridor;
  corridor.correction.rotation.setConstant(4e-4);
  BundleProblem problem = MakeCorridor(corridor).problem;
  problem.correction.rotation = {1e-4, 2e-4, 3e-4};
  problem.correction_sigma_rad = {5e-3, 0, 0};
  const BundleResult result = AdjustBundle(problem, {});
  EXPECT_NE(result.correction.rotation.x(), 1e-4);
  EXPECT_EQ(result.correction.rotation.y(), 2e-4);
  EXPECT_EQ(result.correction.rotation.z(), 3e-4);
  EXPECT_GT(result.correction_covariance(0, 0), 0);
  EXPECT_TRUE(result.correction_covariance.bottomRightCorner(2, 2).isZero(0));
}

TEST(SelfCalibration, ATightPriorHoldsTheCorrection) {
  CorridorOptions corridor;
  corridor.correction.rotation.setConstant(4e-4);
  BundleProblem problem = MakeCorridor(corridor).problem;
  problem.correction_mean_rad.setConstant(-1e-4);
  problem.correction_sigma_rad.setConstant(1e-8);
  const BundleResult result = AdjustBundle(problem, {});
  EXPECT_LT((result.correction.rotation - problem.correction_mean_rad).norm(), 1e-7);
}

}  // namespace
}  // namespace arfm_vo
