#include "arfm_vo/odometry/base_covariance.h"

#include <gtest/gtest.h>

#include <random>

namespace arfm_vo {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
const Rigid3 kMount(ExpSO3({0.4, -0.7, 0.2}), Eigen::Vector3d(0.5, -0.3, 1.2));

/// (place, rotation) error of `noisy` against `truth`, axes of odom.
Vector6 ErrorInOdom(const Rigid3& noisy, const Rigid3& truth) {
  Vector6 error;
  error << noisy.translation - truth.translation,
      LogSO3(noisy.rotation * truth.rotation.conjugate());
  return error;
}

Vector6 Draw(const Vector6& sigma, std::mt19937& engine) {
  std::normal_distribution<double> normal;
  Vector6 step;
  for (int i = 0; i < 6; ++i) step[i] = sigma[i] * normal(engine);
  return step;
}

TEST(PoseCovariance, AYawErrorOfTheCameraMovesTheBaseAtTheEndOfTheLever) {
  Matrix6 camera = Matrix6::Zero();
  camera(2, 2) = 1e-4;  // rotation about z, 0.01 rad
  const Rigid3 base_from_camera(Eigen::Quaterniond::Identity(), Eigen::Vector3d(2, 0, 0));
  const Matrix6 base = BaseCovariance(camera, base_from_camera);
  EXPECT_NEAR(base(1, 1), 4e-4, 1e-15);  // 2 m * 0.01 rad sideways
  EXPECT_NEAR(base(5, 5), 1e-4, 1e-15);
  EXPECT_NEAR(base(0, 0), 0, 1e-15);
}

TEST(PoseCovariance, AgreesWithDrawnCameraPoses) {
  Vector6 sigma;
  sigma << 1e-3, 2e-3, 3e-3, 4e-3, 5e-3, 6e-3;
  const Rigid3 camera_from_world(ExpSO3({0.3, 0.2, -0.5}), Eigen::Vector3d(1, 2, 3));
  const auto base = [&](const Rigid3& camera) { return camera.Inverse() * kMount.Inverse(); };
  const Rigid3 truth = base(camera_from_world);
  std::mt19937 engine(7);
  Matrix6 sum = Matrix6::Zero();
  constexpr int kDraws = 20000;
  for (int i = 0; i < kDraws; ++i) {
    const Vector6 error = ErrorInOdom(base(BoxPlus(camera_from_world, Draw(sigma, engine))), truth);
    sum += error * error.transpose();
  }
  const Matrix6 camera_covariance = sigma.cwiseAbs2().asDiagonal();
  const Matrix6 expected = DriftCovariance().At(Rigid3(truth.rotation, Eigen::Vector3d::Zero()),
                                                BaseCovariance(camera_covariance, kMount));
  EXPECT_LT((sum / kDraws - expected).norm(), 0.03 * expected.norm());
}

TEST(DriftCovariance, AnUnsureHeadingMakesThePlaceUnsureWithTheWay) {
  DriftCovariance drift;
  Matrix6 base = Matrix6::Zero();
  base(5, 5) = 1e-4;  // heading, 0.01 rad
  drift.StartEpoch(Rigid3(), base, Matrix6::Zero());
  const Rigid3 ahead(Eigen::Quaterniond::Identity(), Eigen::Vector3d(10, 0, 0));
  const Matrix6 covariance = drift.At(ahead, Matrix6::Zero());
  EXPECT_NEAR(covariance(1, 1), 1e-2, 1e-12);  // (10 m * 0.01 rad)^2
  EXPECT_NEAR(covariance(5, 5), 1e-4, 1e-12);
}

TEST(DriftCovariance, TheWayCountsFromWhereTheEpochBegan) {
  DriftCovariance drift;
  Matrix6 base = Matrix6::Zero();
  base(5, 5) = 1e-4;
  const auto ahead = [](double way_m) {
    return Rigid3(Eigen::Quaterniond::Identity(), Eigen::Vector3d(way_m, 0, 0));
  };
  drift.StartEpoch(ahead(10), base, Matrix6::Zero());
  EXPECT_NEAR(drift.At(ahead(10), Matrix6::Zero())(1, 1), 0, 1e-12);
  EXPECT_NEAR(drift.At(ahead(15), Matrix6::Zero())(1, 1), 25e-4, 1e-12);
}

TEST(DriftCovariance, KeepsWhatWasUnsureWhenTheWorldBegan) {
  DriftCovariance drift;
  const Matrix6 base = Matrix6::Identity() * 1e-6;
  EXPECT_NEAR(drift.At(Rigid3(), base)(0, 0), 1e-6, 1e-15);
  drift.StartEpoch(Rigid3(), drift.At(Rigid3(), base), 4 * base);
  EXPECT_NEAR(drift.At(Rigid3(), base)(0, 0), 6e-6, 1e-15);
  EXPECT_NEAR(drift.At(Rigid3(), base)(0, 0), 6e-6, 1e-15);
}

}  // namespace
}  // namespace arfm_vo
