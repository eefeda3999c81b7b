#include "arfm_vo/odometry/calibration_state.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

constexpr int kFocalLength = StereoCorrection::kNumField + RadialBasis::kFocalLength;
const StereoCamera kCamera{700, 700, 320, 240, 0.3, 640, 480};
const CorrectionBelief kCalibration = CorrectionBelief::OfCalibration(kCamera);

BundleResult Found(const StereoCorrection::Coefficients& px, double sigma_px) {
  BundleResult result;
  result.status = BundleStatus::kConverged;
  result.correction.coefficients_px = px;
  result.correction_covariance = CorrectionBelief::Isotropic(sigma_px).covariance;
  return result;
}

StereoCorrection::Coefficients Yaw(double mrad) {
  return 1e-3 * mrad * CorrectionBelief::ByTurn(kCamera).col(1);
}

/// What windows of a camera that stands `mrad` find, a little beside it in turn.
BundleResult Window(double mrad, int number) {
  return Found(Yaw(mrad + 0.02 * ((number / 4) % 2)), 0.01);
}

/// A state that has learnt zero from six keyframes.
CalibrationState Known() {
  CalibrationState state(kCamera, true, kCalibration);
  state.Learn(Found(Yaw(0), 0.01), 6);
  return state;
}

TEST(CalibrationState, IsFoundOnceAndThenLeft) {
  CalibrationState state(kCamera, true, kCalibration);
  EXPECT_TRUE(state.Prior());
  EXPECT_FALSE(state.WindowPrior(6)) << "there is nothing to compare with";
  EXPECT_TRUE(state.Learn(Found(Yaw(0.2), 0.2), 4));
  EXPECT_TRUE(state.Prior()) << "0.2 px are not known well";
  EXPECT_TRUE(state.Learn(Found(Yaw(0.3), 0.01), 6));
  EXPECT_FALSE(state.Prior());
  EXPECT_EQ(state.correction().mean.coefficients_px, Yaw(0.3));
  EXPECT_FALSE(state.WindowPrior(6)) << "no news";
  EXPECT_TRUE(state.WindowPrior(7));
}

TEST(CalibrationState, AnAdjustmentWithoutACovarianceSaysNothing) {
  CalibrationState state(kCamera, true, kCalibration);
  EXPECT_FALSE(state.Learn(Found(Yaw(1), 0), 6));
  EXPECT_TRUE(state.correction().mean.IsZero());
  EXPECT_EQ(state.correction().covariance, kCalibration.covariance);
}

TEST(CalibrationState, TurnsOpenItAndScatterHoldsTheFocalLength) {
  CalibrationState state = Known();
  for (int k = 7; k < 40; ++k) state.Follow(Found(Yaw((k / 4) % 2 ? 0.06 : -0.06), 0.01), k);
  state.AddTurn(0.4);
  EXPECT_FALSE(state.Prior());
  state.AddTurn(0.2);
  ASSERT_TRUE(state.Prior());
  EXPECT_LT(state.Prior()->covariance(kFocalLength, kFocalLength),
            0.3 * kCalibration.covariance(kFocalLength, kFocalLength));
  state.Learn(Found(Yaw(0), 0.01), 40);
  EXPECT_FALSE(state.Prior());
}

TEST(CalibrationState, WindowsThatScatterWidenTheCovariance) {
  CalibrationState quiet = Known(), loud = Known();
  for (int k = 7; k < 40; ++k) {
    quiet.Follow(Window(0, 0), k);
    loud.Follow(Found(Yaw((k / 4) % 2 ? 0.06 : -0.06), 0.01), k);
  }
  EXPECT_EQ(quiet.first_telling(), 0);
  EXPECT_EQ(loud.first_telling(), 0);
  EXPECT_EQ(loud.correction().mean.coefficients_px, Yaw(0));
  EXPECT_GT(loud.correction().covariance(0, 0), 1.2 * quiet.correction().covariance(0, 0));
}

TEST(CalibrationState, ATurnOpensItFromThereOnAndTwoWindowsSettleIt) {
  CalibrationState state = Known();
  for (int k = 7; k < 20; ++k) state.Follow(Window(0, k), k);
  EXPECT_FALSE(state.HasTurned());
  const double before = state.correction().covariance(0, 0);
  state.Follow(Window(0.8, 20), 20);
  ASSERT_TRUE(state.HasTurned());
  EXPECT_EQ(state.first_telling(), 16);
  EXPECT_GT(state.correction().covariance(0, 0), before + 0.3);
  const Eigen::Vector3d lens = state.Prior()->covariance.diagonal().segment<3>(10);
  EXPECT_LT(lens.maxCoeff(), 1e-4) << "the lens is the same";
  for (int k = 20; k < 24; ++k) {
    EXPECT_TRUE(state.HasTurned()) << k;
    state.Learn(Found(Yaw(0.8), 0.01), k);
  }
  state.Learn(Found(Yaw(0.8), 0.01), 24);
  EXPECT_FALSE(state.Prior());
  EXPECT_EQ(state.correction().mean.coefficients_px, Yaw(0.8));
  EXPECT_LT(state.correction().covariance(0, 0), before + 0.1);
}

TEST(CalibrationState, ASlowTurnIsNotTakenForScatter) {
  CalibrationState state = Known();
  int k = 7;
  while (!state.HasTurned() && k < 60) {
    state.Follow(Window(0.02 * (k - 6), k), k);
    ++k;
  }
  EXPECT_LT(k, 30);
}

TEST(CalibrationState, SwitchedOffItStaysAsItIs) {
  CalibrationState state(kCamera, false, kCalibration);
  EXPECT_FALSE(state.Prior());
  EXPECT_FALSE(state.WindowPrior(20));
  EXPECT_EQ(state.correction().covariance, kCalibration.covariance);
}

}  // namespace
}  // namespace arfm_vo
