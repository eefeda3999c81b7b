#include "arfm_vo/bundle_adjustment/pose_information.h"

#include <gtest/gtest.h>

#include "arfm_vo/base/chi_square.h"
#include "arfm_vo/geometry/linear_algebra.h"
#include "bundle_adjustment/bundle_scene.h"

namespace arfm_vo {
namespace {

CorridorScene MakeScene() {
  CorridorOptions corridor;
  corridor.num_poses = 6;
  corridor.num_points = 100;
  corridor.outlier_share = 0.05;
  return MakeCorridor(corridor);
}

TEST(PoseInformation, ItsInverseIsTheCovarianceOfTheNewestPose) {
  constexpr int kTrials = 150, kNumMoving = 3;
  double sum = 0;
  CorridorOptions corridor;
  corridor.num_poses = 5;
  corridor.num_points = 80;
  BundleOptions options;
  options.with_point_covariance = true;  // weights are measured for it
  for (int trial = 0; trial < kTrials; ++trial) {
    corridor.seed = trial + 1;
    const CorridorScene scene = MakeCorridor(corridor);
    const BundleResult result = AdjustBundle(scene.problem, options);
    const Eigen::MatrixXd information = FindPoseInformation(scene.problem, result, options).poses;
    const Eigen::MatrixXd covariance =
        InvertDefinite(information.bottomRightCorner(6 * kNumMoving, 6 * kNumMoving));
    const auto step = StepBetween(scene.camera_from_world.back(), result.camera_from_world.back());
    sum += SquaredMahalanobis(step, covariance.bottomRightCorner<6, 6>());
  }
  EXPECT_GT(sum, ChiSquareQuantile(6 * kTrials, 0.025));
  EXPECT_LT(sum, ChiSquareQuantile(6 * kTrials, 0.975));
}

TEST(PoseInformation, SaysNothingOfAMotionOfTheWholeWorld) {
  const CorridorScene scene = MakeScene();
  const BundleOptions options;
  const BundleResult result = AdjustBundle(scene.problem, options);
  const Eigen::MatrixXd information = FindPoseInformation(scene.problem, result, options).poses;
  // A shift of the world by d moves each camera's origin by R d.
  Eigen::VectorXd shift = Eigen::VectorXd::Zero(information.rows());
  for (size_t i = 0; i < result.camera_from_world.size(); ++i) {
    shift.segment<3>(6 * i + 3) =
        result.camera_from_world[i].rotation * Eigen::Vector3d(0.3, -0.2, 0.5);
  }
  EXPECT_LT((information * shift).norm(), 1e-9 * information.norm());
  EXPECT_LT((information - information.transpose()).norm(), 1e-9 * information.norm());
}

TEST(PoseInformation, TellsHowThePosesMoveWithTheCorrection) {
  CorridorScene scene = MakeScene();
  BundleOptions options;
  options.function_tolerance = 1e-12;
  options.max_iterations = 50;
  options.loss = LossKind::kSquared;
  const BundleResult held = AdjustBundle(scene.problem, options);
  const PoseInformation information = FindPoseInformation(scene.problem, held, options);
  StereoCorrection::Coefficients step = StereoCorrection::Coefficients::Zero();
  step.head<4>() << 0.02, -0.01, 0.01, 0.015;
  step.segment<StereoCorrection::kNumLens>(StereoCorrection::kNumField) << 0.02, 0.03, -0.02, 0.02,
      -0.03;
  scene.problem.correction.coefficients_px = step;
  const BundleResult moved = AdjustBundle(scene.problem, options);
  constexpr int kFirst = 2, kSize = 6 * 4;  // two poses are held
  const Eigen::VectorXd expected = -SolveSymmetric(
      information.poses.bottomRightCorner(kSize, kSize),
      information.by_correction.bottomRows(kSize) * step.head<StereoCorrection::kNumPlacing>());
  for (int pose = kFirst; pose < 6; ++pose) {
    const Rigid3 motion = moved.camera_from_world[pose] * held.camera_from_world[pose].Inverse();
    const Eigen::Vector3d shift = moved.camera_from_world[pose].translation -
                                  motion.rotation * held.camera_from_world[pose].translation;
    EXPECT_GT(shift.norm(), 1e-4);
    EXPECT_LT((shift - expected.segment<3>(6 * (pose - kFirst) + 3)).norm(), 0.05 * shift.norm());
  }
}

}  // namespace
}  // namespace arfm_vo
