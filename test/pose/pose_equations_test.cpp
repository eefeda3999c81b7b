#include "../../src/pose/pose_equations.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <vector>

#include "arfm_vo/pose/reprojection.h"
#include "arfm_vo/pose/robust_loss.h"
#include "pose/pose_scene.h"

namespace arfm_vo {
namespace {

using Matrix36d = Eigen::Matrix<double, 3, 6>;

TEST(Reprojection, JacobianAgreesWithNumericDerivatives) {
  RandomEngine engine(1);
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Vector3d x = RandomVisiblePoint(engine, 2, 40);
    const Eigen::Matrix3d jacobian = ProjectionJacobian(kSceneCamera, x);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = 1e-5 * Eigen::Vector3d::Unit(i);
      const Eigen::Vector3d numeric =
          (kSceneCamera.ProjectStereo(x + step) - kSceneCamera.ProjectStereo(x - step)) / 2e-5;
      EXPECT_LT((jacobian.col(i) - numeric).norm(), 1e-5 * (1 + numeric.norm()));
    }
  }
}

/// The error, information and equations of one correspondence, as the formulas read.
struct PlainCorrespondence {
  Eigen::Vector3d error = Eigen::Vector3d::Zero();
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Matrix36d jacobian = Matrix36d::Zero();
  double squared = kBehindCamera;

  PlainCorrespondence(const PointObservation& observation, const Rigid3& pose) {
    const Eigen::Vector3d x = pose * observation.x_in_world;
    if (!(x.z() > kMinDepth)) return;
    error = ReprojectionError(kSceneCamera, observation, x);
    const Eigen::Matrix3d a = ProjectionJacobian(kSceneCamera, x);
    const Eigen::Matrix3d j = a * pose.RotationMatrix();
    const Eigen::Matrix3d s =
        j * observation.x_covariance * j.transpose() +
        observation.sigma_px * observation.sigma_px * Eigen::Matrix3d::Identity();
    const int k = observation.NumCoordinates();
    information.topLeftCorner(k, k) = s.topLeftCorner(k, k).inverse();
    jacobian << -a * Skew(x), a;
    squared = error.dot(information * error);
  }
};

/// Uncertain points, some without a right pixel and one behind the camera; no multiple of four.
std::vector<PointObservation> MixedObservations(const Rigid3& pose, RandomEngine& engine) {
  std::vector<PointObservation> observations = MakeObservations(pose, 42, 0.7, engine);
  for (size_t i = 0; i < observations.size(); ++i) {
    Eigen::Matrix3d spread;
    for (int k = 0; k < 3; ++k) spread.col(k) = 0.1 * RandomNormal3(engine);
    observations[i].x_covariance = spread * spread.transpose();
    observations[i].has_right = i % 3 != 0;
    observations[i].sigma_px = 0.1 + RandomUnit(engine);
  }
  observations[5].x_in_world = pose.Inverse() * Eigen::Vector3d(1, 2, -3);
  return observations;
}

class PoseEquationsTest : public testing::TestWithParam<const PoseKernels*> {
 protected:
  void SetUp() override {
    const bool can_run = GetParam() == &kPoseKernelsBaseline || GetParam() == &ChoosePoseKernels();
    if (!can_run) GTEST_SKIP() << "this CPU has no AVX2";
  }
};

TEST_P(PoseEquationsTest, AgreesWithTheFormulas) {
  RandomEngine engine(2);
  for (int trial = 0; trial < 10; ++trial) {
    const Rigid3 truth = RandomPose(engine, 0.3, 2);
    const std::vector<PointObservation> observations = MixedObservations(truth, engine);
    const Rigid3 pose = BoxPlus(truth, 1e-3 * Eigen::Matrix<double, 6, 1>::Ones());
    PoseEquations equations(kSceneCamera, observations, *GetParam());
    equations.UpdateInformation(pose);
    const double* squared = equations.SquareErrors(pose);
    std::vector<double> weights;
    Eigen::Matrix<double, 6, 6> hessian = Eigen::Matrix<double, 6, 6>::Zero();
    Eigen::Matrix<double, 6, 1> gradient = Eigen::Matrix<double, 6, 1>::Zero();
    for (size_t i = 0; i < observations.size(); ++i) {
      const PlainCorrespondence plain(observations[i], pose);
      EXPECT_LT((equations.Information(static_cast<int>(i)) - plain.information).norm(),
                1e-9 * (1 + plain.information.norm()));
      EXPECT_NEAR(squared[i], plain.squared, 1e-9 * (1 + plain.squared));
      weights.push_back(i % 7 == 0 ? 0 : RandomUnit(engine));
      const Matrix36d weighted = weights.back() * plain.information * plain.jacobian;
      hessian += plain.jacobian.transpose() * weighted;
      gradient += weighted.transpose() * plain.error;
    }
    const PoseNormalEquations sums = equations.Accumulate(pose, weights);
    EXPECT_LT((sums.hessian - hessian).norm(), 1e-10 * hessian.norm());
    EXPECT_LT((sums.gradient - gradient).norm(), 1e-10 * gradient.norm());
  }
}

TEST_P(PoseEquationsTest, SpreadAlongTheRayWidensTheRightPixelAlone) {
  PointObservation observation;  // on the optical axis: depth changes disparity, not (u, v)
  observation.x_in_world = {0, 0, 10};
  observation.x_covariance = Eigen::Vector3d(0, 0, 0.25).asDiagonal();
  observation.pixels.setZero();
  PoseEquations equations(kSceneCamera, {observation}, *GetParam());
  equations.UpdateInformation(Rigid3());
  const double slope = 707 * 0.54 / 100;  // px per m
  const Eigen::Vector3d expected(1, 1, 1 / (1 + 0.25 * slope * slope));
  EXPECT_LT((equations.Information(0) - Eigen::Matrix3d(expected.asDiagonal())).norm(), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Sets, PoseEquationsTest,
                         testing::Values(&kPoseKernelsBaseline, &kPoseKernelsAvx2),
                         [](const auto& info) { return info.index ? "Avx2" : "Baseline"; });

TEST(LossSum, IsTheSumOfTheLosses) {
  for (const auto& [name, kind] : ListNames(LossKind())) {
    const RobustLoss loss(kind, 2, 3);
    LossSum sum(loss);
    double expected = 0;
    for (int i = 0; i < 500; ++i) {
      const double s = i % 10 == 0 ? kBehindCamera : 0.1 * i;
      sum.Add(s);
      expected += loss.Rho(s);
    }
    EXPECT_NEAR(sum.Sum(), expected, 1e-9 * expected) << name;
  }
}

}  // namespace
}  // namespace arfm_vo
