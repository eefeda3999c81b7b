#include "arfm_vo/odometry/drift_estimator.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace arfm_vo {
namespace {

using Matrix6 = DriftEstimator::Matrix6;
const Matrix6 kOne = Matrix6::Identity();

PoseDrift Noise(const Matrix6& covariance) {
  PoseDrift drift;
  drift.covariance = covariance;
  return drift;
}

/// The information of a chain of poses, `weight` on each step and no lever between them.
PoseInformation Chain(int num_poses, double weight) {
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(6 * num_poses, 6 * num_poses);
  for (int i = 0; i + 1 < num_poses; ++i) {
    information.block<6, 6>(6 * i, 6 * i) += weight * kOne;
    information.block<6, 6>(6 * i + 6, 6 * i + 6) += weight * kOne;
    information.block<6, 6>(6 * i, 6 * i + 6) -= weight * kOne;
    information.block<6, 6>(6 * i + 6, 6 * i) -= weight * kOne;
  }
  return {information, Eigen::MatrixXd::Zero(6 * num_poses, StereoCorrection::kNumPlacing)};
}

TEST(DriftEstimator, EachStepOfAChainAddsItsVariance) {
  DriftEstimator drift;
  drift.Add(0, Noise(Matrix6::Zero()));
  for (int k = 1; k <= 5; ++k) {
    drift.Add(k, Noise(99 * kOne));  // until the window is adjusted
    drift.Update({k - 1, k}, {1, 0}, Chain(2, 4));
  }
  EXPECT_NEAR((drift.Covariance(5) - 5 * 0.25 * kOne).norm(), 0, 1e-12);
}

TEST(DriftEstimator, AWindowOfManyIsTheSameAsItsSteps) {
  DriftEstimator drift;
  for (int k = 0; k < 4; ++k) drift.Add(k, Noise(k * kOne));
  drift.Update({0, 1, 2, 3}, {1, 0, 0, 0}, Chain(4, 2));
  for (int k = 0; k < 4; ++k) EXPECT_NEAR((drift.Covariance(k) - k * 0.5 * kOne).norm(), 0, 1e-12);
}

TEST(DriftEstimator, HeldKeyframesThatErrAlikeDoNotHelpEachOther) {
  DriftEstimator drift;
  drift.Add(0, Noise(Matrix6::Zero()));
  drift.Add(1, Noise(kOne));
  drift.Add(2, Noise(kOne));
  drift.Update({0, 1}, {1, 0}, Chain(2, 1));     // 1: variance 1
  drift.Update({1, 2}, {1, 0}, Chain(2, 1e12));  // 2 errs just as 1 does
  drift.Add(3, Noise(kOne));
  Eigen::MatrixXd information = Eigen::MatrixXd::Zero(18, 18);  // 3 hangs from 1 and from 2
  information.bottomRightCorner<6, 6>() = 2 * kOne;
  information.block<6, 6>(12, 0) = information.block<6, 6>(12, 6) = -kOne;
  information.block<6, 6>(0, 12) = information.block<6, 6>(6, 12) = -kOne;
  drift.Update({1, 2, 3}, {1, 1, 0},
               {information, Eigen::MatrixXd::Zero(18, StereoCorrection::kNumPlacing)});
  EXPECT_NEAR((drift.Covariance(3) - 1.5 * kOne).norm(), 0, 1e-6);
}

/// Each step is too long by 0.01 m a pixel of the first coefficient: errors that add up, unlike
/// noise.
TEST(DriftEstimator, AnUnknownCorrectionErrsAlikeInEachStep) {
  DriftEstimator drift;
  CorrectionBelief correction = CorrectionBelief::Isotropic(0.5);
  drift.SetCorrection(correction);
  drift.Add(0, Noise(Matrix6::Zero()));
  const auto drive = [&](int first, int last) {
    for (int k = first; k <= last; ++k) {
      drift.Add(k, drift.Beside(k - 1, Rigid3(), Noise(kOne)));
      PoseInformation step = Chain(2, 1e12);
      step.by_correction(6 + 5, 0) = -1e12 * 0.01;
      drift.Update({k - 1, k}, {1, 0}, step);
    }
  };
  drive(1, 10);
  EXPECT_NEAR(std::sqrt(drift.Covariance(10)(5, 5)), 10 * 0.01 * 0.5, 1e-6);
  correction = CorrectionBelief::Isotropic(0.1);
  drift.SetCorrection(correction);  // known better: what was driven so far stays as unsure
  EXPECT_NEAR(std::sqrt(drift.Covariance(10)(5, 5)), 10 * 0.01 * 0.5, 1e-6);
  drive(11, 20);
  const double settled = std::pow(10 * 0.01, 2) * (0.5 * 0.5 - 0.1 * 0.1);
  EXPECT_NEAR(drift.Covariance(20)(5, 5), settled + std::pow(20 * 0.01 * 0.1, 2), 1e-6);
  drift.SetCorrection(CorrectionBelief::Isotropic(0.5));  // of a camera that has changed
  drive(21, 30);
  // Of 30 steps by what was unknown before, and of 10 by how it has changed since.
  const double changed = std::pow(10 * 0.01, 2) * (0.5 * 0.5 - 0.1 * 0.1);
  EXPECT_NEAR(drift.Covariance(30)(5, 5), settled + std::pow(30 * 0.01 * 0.1, 2) + changed, 1e-6);
}

/// The adjustment that tells the correction moves older keyframes to where they were against the
/// newest one, which stays with the error that it has.
TEST(DriftEstimator, KeyframesThatMoveWithAnAnchorErrAsItDoes) {
  const auto learn = [](const std::map<KeyframeId, Rigid3>& moved) {
    DriftEstimator drift;
    drift.SetCorrection(CorrectionBelief::Isotropic(0.5));
    PoseDrift driven;
    driven.by_correction(5, 0) = 0.01;
    drift.Add(0, driven);
    driven.by_correction(5, 0) = 0.1;
    drift.Add(1, driven);
    drift.SetCorrection(CorrectionBelief::Isotropic(0.1), 1, moved);
    drift.Update({0, 1}, {1, 0}, Chain(2, 1e12));  // no more unsure than the older one
    return std::sqrt(drift.Covariance(1)(5, 5));
  };
  EXPECT_NEAR(learn({{0, Rigid3()}}), 0.1 * 0.5, 0.002);
  EXPECT_NEAR(learn({}), 0.01 * 0.5, 0.002);
}

TEST(DriftEstimator, WhatIsForgottenLeavesTheRestAsItWas) {
  DriftEstimator drift;
  for (int k = 0; k < 4; ++k) drift.Add(k, Noise(k * kOne));
  drift.Forget(2);
  EXPECT_EQ(drift.Covariance(1), Matrix6(Matrix6::Zero()));
  EXPECT_EQ(drift.Covariance(3), Matrix6(3 * kOne));
  drift.Add(4, Noise(kOne));
  EXPECT_EQ(drift.Covariance(4), kOne);
}

TEST(DriftEstimator, APoseBesideAKeyframeHasTheKeyframesDriftAndItsOwn) {
  DriftEstimator drift;
  drift.Add(0, Noise(2 * kOne));
  const Rigid3 ahead(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -3));
  const Matrix6 covariance = drift.Beside(0, ahead, Noise(kOne)).covariance;
  EXPECT_NEAR(covariance(5, 5), 3, 1e-12);
  EXPECT_NEAR(covariance(3, 3), 3 + 9 * 2, 1e-12);  // 3 m ahead of an unsure direction
}

TEST(DriftEstimator, ChangesNothingWhereTheInformationDoesNotFixThePoses) {
  DriftEstimator drift;
  drift.Add(0, Noise(Matrix6::Zero()));
  drift.Add(1, Noise(kOne));
  drift.Update({0, 1}, {1, 0}, {Eigen::MatrixXd::Zero(12, 12), Eigen::MatrixXd::Zero(12, 10)});
  EXPECT_EQ(drift.Covariance(1), kOne);
}

TEST(DriftEstimator, RefusesKeyframesItDoesNotKnow) {
  DriftEstimator drift;
  drift.Add(3, Noise(kOne));
  EXPECT_THROW(drift.Add(3, Noise(kOne)), std::invalid_argument);
  EXPECT_THROW(drift.Update({2, 3}, {1, 0}, Chain(2, 1)), std::invalid_argument);
}

TEST(CarryCovariance, AnUnsureDirectionMakesThePlaceUnsureAtTheEndOfTheWay) {
  Matrix6 covariance = Matrix6::Zero();
  covariance(1, 1) = 1e-4;  // about the vertical, 0.01 rad
  const Rigid3 b_from_a(Eigen::Quaterniond::Identity(), Eigen::Vector3d(0, 0, -10));  // 10 m ahead
  const Matrix6 carried = CarryCovariance(b_from_a, covariance);
  EXPECT_NEAR(carried(3, 3), 1e-2, 1e-12);  // (10 m * 0.01 rad)^2 sideways
  EXPECT_NEAR(carried(1, 1), 1e-4, 1e-12);
  EXPECT_NEAR(carried(5, 5), 0, 1e-12);
}

}  // namespace
}  // namespace arfm_vo
