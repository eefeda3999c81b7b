#include <gtest/gtest.h>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/bundle_adjustment/bundle_adjustment.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

using Coefficients = StereoCorrection::Coefficients;

/// Small errors of the right camera: a turn about each axis, and what its lens leaves; and radial
/// ones of both.
Coefficients MakeDisplacement() {
  Coefficients coefficients = Coefficients::Zero();
  coefficients[0] = 0.2;
  coefficients[3] = 0.15;
  coefficients[6] = -0.1;
  coefficients.segment<StereoCorrection::kNumLens>(StereoCorrection::kNumField) << 2, -1, 0.5, 0.4,
      -0.3;
  constexpr int kRows = StereoCorrection::kNumPlacing;
  coefficients[kRows] = -0.3;
  coefficients[kRows + 1] = 0.2;
  coefficients[kRows + 4] = 0.4;
  return coefficients;
}

/// The squared distance of an estimate from the truth in units of its stated covariance.
double SquaredDistance(const BundleResult& result, const Coefficients& truth) {
  const Coefficients error = result.correction.coefficients_px - truth;
  return SquaredMahalanobis(error, result.correction_covariance);
}

CorridorOptions MakeOptions(const Coefficients& displacement) {
  CorridorOptions corridor;
  corridor.num_poses = 12;
  corridor.num_points = 800;
  corridor.turn_rad = 0.05;  // straight ways do not tell the focal length
  corridor.noise_px = 0.2;   // what aligned patches have
  corridor.num_fixed = 1;    // two would tell the scale
  corridor.correction.coefficients_px = displacement;
  return corridor;
}

BundleResult Calibrate(const CorridorOptions& corridor) {
  BundleProblem problem = MakeCorridor(corridor).problem;
  problem.correction_prior = CorrectionBelief::Isotropic(5);  // no help
  BundleOptions options;
  options.function_tolerance = 1e-10;  // what is told worst settles last
  return AdjustBundle(problem, options);
}

TEST(SelfCalibration, FindsTheDisplacementOfTheRightImageFromNoisyImagesAlone) {
  const Coefficients truth = MakeDisplacement();
  CorridorOptions corridor = MakeOptions(truth);
  corridor.num_poses = 24;
  corridor.num_points = 1600;
  corridor.turn_rad = 0.07;
  const BundleResult result = Calibrate(corridor);
  EXPECT_LT(SquaredDistance(result, truth), ChiSquareQuantile(StereoCorrection::kSize, 0.99));
  for (int i = 0; i < StereoCorrection::kSize; ++i) {
    const double sigma = std::sqrt(result.correction_covariance(i, i));
    const bool is_radial = i >= StereoCorrection::kNumField && i < StereoCorrection::kNumPlacing;
    EXPECT_LT(sigma, is_radial ? 0.5 : 0.1) << "coefficient " << i << " is not worth stating";
    EXPECT_NEAR(result.correction.coefficients_px[i], truth[i], 4 * sigma) << i;
  }
}

/// A turn of the right camera by 0.4, 0.8 and -0.6 mrad, and all else held by the prior.
TEST(SelfCalibration, FindsTheSameTurnWhereTheCorrectionMayNotMoveOtherwise) {
  const CorrectionBelief::Turns turns = CorrectionBelief::ByTurn(kBundleCamera);
  const Eigen::Vector3d turn_rad(4e-4, 8e-4, -6e-4);
  BundleProblem problem = MakeCorridor(MakeOptions(turns * turn_rad)).problem;
  problem.correction_prior = CorrectionBelief::Isotropic(1e-3);
  problem.correction_prior->covariance += Propagate(turns, 1e-6 * Eigen::Matrix3d::Identity());
  BundleOptions options;
  options.function_tolerance = 1e-10;
  const BundleResult whole = AdjustBundle(problem, options);
  problem.correction_turns = turns;
  const BundleResult alone = AdjustBundle(problem, options);
  const Eigen::MatrixXd to_turn = CorrectionBelief::ToTurn(problem.camera);
  const auto turn = [&](const BundleResult& result) -> Eigen::Vector3d {
    return to_turn * result.correction.coefficients_px;
  };
  const auto variance = [&](const BundleResult& result) {
    return Propagate(to_turn, result.correction_covariance).trace();
  };
  EXPECT_LT((turn(alone) - turn(whole)).norm(), 1e-5);
  EXPECT_LT((turn(alone) - turn_rad).norm(), 1e-4);
  EXPECT_NEAR(variance(alone), variance(whole), 0.05 * variance(whole));
}

TEST(SelfCalibration, StatesAnHonestCovarianceWithAndWithoutADisplacement) {
  constexpr int kTrials = 60, kSize = StereoCorrection::kSize;
  for (const double share : {0.0, 1.0}) {
    const Coefficients truth = share * MakeDisplacement();
    double sum = 0;
    int num_significant = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      CorridorOptions corridor = MakeOptions(truth);
      corridor.num_poses = 8;
      corridor.num_points = 600;  // fewer tell the lens too little for a linear covariance
      corridor.seed = 1 + trial;
      const BundleResult result = Calibrate(corridor);
      sum += SquaredDistance(result, truth);
      num_significant +=
          SquaredDistance(result, Coefficients::Zero()) > ChiSquareQuantile(kSize, 0.99);
    }
    EXPECT_GT(sum, ChiSquareQuantile(kSize * kTrials, 0.025)) << share;
    EXPECT_LT(sum, ChiSquareQuantile(kSize * kTrials, 0.975)) << share;
    if (share == 0) {
      EXPECT_LE(num_significant, 3);
    } else {
      EXPECT_GE(num_significant, kTrials * 9 / 10);
    }
  }
}

TEST(SelfCalibration, AFrozenCorrectionStaysWhereItStartsAndIsUsed) {
  const CorridorOptions corridor = MakeOptions(MakeDisplacement());
  BundleProblem problem = MakeCorridor(corridor).problem;
  const double cost_without = AdjustBundle(problem, {}).final_cost;
  problem.correction = corridor.correction;
  const BundleResult result = AdjustBundle(problem, {});
  EXPECT_EQ(result.correction.coefficients_px, corridor.correction.coefficients_px);
  EXPECT_TRUE(result.correction_covariance.isZero(0));
  EXPECT_LT(result.final_cost, 0.99 * cost_without);
}

TEST(SelfCalibration, ATightPriorHoldsTheCorrection) {
  BundleProblem problem = MakeCorridor(MakeOptions(MakeDisplacement())).problem;
  problem.correction_prior = CorrectionBelief::Isotropic(1e-6);
  EXPECT_LT(AdjustBundle(problem, {}).correction.coefficients_px.norm(), 1e-5);
}

TEST(SelfCalibration, PointsTooFarToBePlacedDoNotTakeTheCovarianceAway) {
  CorridorScene scene = MakeCorridor(MakeOptions(MakeDisplacement()));
  BundleProblem& problem = scene.problem;
  problem.correction_prior = CorrectionBelief::Isotropic(5);
  for (int i = 0; i < 40; ++i) {
    const int point = static_cast<int>(problem.points.size());
    const Eigen::Vector3d star(1e9 * (i - 20), -3e9, 1e11);
    problem.points.push_back(star);
    for (const int pose : {0, 1, 2}) {
      const Eigen::Vector3d x = scene.camera_from_world[pose].rotation * star;
      BundleObservation seen{
          {ProjectStereo4(kBundleCamera, {}, x).cast<float>(), false, 0.2}, pose, point};
      problem.observations.push_back(seen);
    }
  }
  const BundleResult result = AdjustBundle(problem, {});
  EXPECT_GT(result.correction_covariance.diagonal().minCoeff(), 0);
  EXPECT_LT(SquaredDistance(result, MakeDisplacement()),
            ChiSquareQuantile(StereoCorrection::kSize, 0.99));
}

/// Half of the information at one value and half at another: between them, with all the certainty.
TEST(SelfCalibration, EarlierInformationCountsAsMuchAsTheObservations) {
  const Coefficients truth = MakeDisplacement();
  BundleProblem problem = MakeCorridor(MakeOptions(truth)).problem;
  problem.correction_prior = CorrectionBelief::Isotropic(5);
  BundleOptions options;
  options.function_tolerance = 1e-12;
  options.max_iterations = 100;
  const BundleResult alone = AdjustBundle(problem, options);
  const Coefficients shift = 0.01 * Coefficients::Ones();
  const auto distance = [&](const Coefficients& step) {  // in standard deviations
    return std::sqrt(SquaredMahalanobis(step, alone.correction_covariance));
  };
  problem.correction_prior->covariance = alone.correction_covariance;
  problem.correction_prior->mean.coefficients_px = alone.correction.coefficients_px + shift;
  for (const BundleSolver solver : {BundleSolver::kOwn, BundleSolver::kCeres}) {
    options.solver = solver;
    const BundleResult both = AdjustBundle(problem, options);
    const Coefficients moved = both.correction.coefficients_px - alone.correction.coefficients_px;
    EXPECT_LT(distance(moved - shift / 2), 0.2 * distance(shift / 2));
    const double ratio = both.correction_covariance.trace() / alone.correction_covariance.trace();
    EXPECT_NEAR(ratio, 0.5, 0.1);
  }
}

}  // namespace
}  // namespace arfm_vo
