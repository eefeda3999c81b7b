#include "arfm_vo/odometry/calibration_state.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arfm_vo {
namespace {

constexpr int kTangential = StereoCorrection::kNumField + LensBasis::kNumRadial;
constexpr int kFocalLength = StereoCorrection::kNumField + LensBasis::kFocalLength;
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
  EXPECT_FALSE(state.WindowPrior(3)) << "too few keyframes";
  EXPECT_TRUE(state.Learn(Found(Yaw(0.2), 0.2), 4));
  EXPECT_TRUE(state.Prior()) << "0.2 px are not known well";
  EXPECT_TRUE(state.Learn(Found(Yaw(0.3), 0.01), 6));
  EXPECT_FALSE(state.Prior());
  EXPECT_EQ(state.correction().mean.coefficients_px, Yaw(0.3));
  EXPECT_FALSE(state.WindowPrior(6)) << "no news";
  EXPECT_TRUE(state.WindowPrior(7));
}

TEST(CalibrationState, AnEarlyKnockIsFollowedAndWhatIsNotKnownYetStaysOpen) {
  CalibrationState by_window(kCamera, true, kCalibration);
  by_window.Learn(Found(Yaw(0), 0.2), 4);
  ASSERT_TRUE(by_window.WindowPrior(5));
  by_window.Follow(Window(3, 5), 5);
  EXPECT_TRUE(by_window.IsTurning());
  CalibrationState by_pair(kCamera, true, kCalibration);
  by_pair.Learn(Found(Yaw(0), 0.2), 4);
  by_pair.Turn({{0, 3e-3, 0}, 1e-8 * Eigen::Matrix3d::Identity()}, 5);
  for (const CalibrationState* state : {&by_window, &by_pair}) {
    ASSERT_TRUE(state->Prior());
    EXPECT_NEAR(state->Prior()->mean.coefficients_px[0], Yaw(3)[0], 0.2 * Yaw(3)[0]);
  }
}

TEST(CalibrationState, ThePriorOfTheTangentialDistortionGivesWayWhereItIsContradicted) {
  const auto variance = [](double found_px) {
    CalibrationState state(kCamera, true, kCalibration);
    StereoCorrection::Coefficients px = Yaw(0);
    px[kTangential] = found_px;
    state.Learn(Found(px, 0.2), 4);
    return state.Prior()->covariance(kTangential, kTangential);
  };
  const double calibrated = kCalibration.covariance(kTangential, kTangential);
  EXPECT_EQ(variance(std::sqrt(calibrated)), calibrated);
  EXPECT_NEAR(variance(4 * std::sqrt(calibrated)), (2 + 16) / 4. * calibrated, 1e-9);
}

TEST(CalibrationState, ATurnThatAPairHasToldEndsWhatEarlierKeyframesTell) {
  CalibrationState state = Known();
  const Eigen::Matrix3d covariance = 1e-8 * Eigen::Matrix3d::Identity();
  state.Turn({{0, 1e-3, 0}, covariance}, 9);
  EXPECT_NEAR((state.correction().mean.coefficients_px - Yaw(1)).norm(), 0, 1e-9);
  EXPECT_EQ(state.first_telling(), 9);
  EXPECT_GT(state.correction().MaxColumnSigma(kCamera), 0.05);
  EXPECT_FALSE(state.WindowPrior(12)) << "keyframe 8, of before, would be in it";
  EXPECT_TRUE(state.WindowPrior(13));
  CalibrationState held(kCamera, false, kCalibration);
  held.Turn({{0, 1e-3, 0}, covariance}, 9);
  EXPECT_TRUE(held.correction().mean.IsZero());
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

/// By an adjustment that has all that the one before had and is twice as sure.
TEST(CalibrationState, AdjustmentsThatMoveByMoreThanTheySayWidenTheCovariance) {
  const auto known = [](double moved_px) {
    CalibrationState state(kCamera, true, kCalibration);
    StereoCorrection::Coefficients px = StereoCorrection::Coefficients::Zero();
    state.Learn(Found(px, 0.2), 2);
    px.head<StereoCorrection::kNumPlacing>().fill(moved_px);
    state.Learn(Found(px, 0.1), 4);
    return state.correction().covariance(0, 0);
  };
  // It moves by sqrt(0.2^2 - 0.1^2) as a rule: so of 3 squares that count 3 and 3/4 of all that
  // count 1, and of as many that count 16.
  const double usual_px = std::sqrt(0.03), model_px2 = 0.05 * 0.05;
  const double num_news = 0.75 * StereoCorrection::kNumPlacing, num = 3 + num_news;
  EXPECT_NEAR(known(usual_px), 0.1 * 0.1 * (9 + num_news) / num + model_px2, 1e-9);
  EXPECT_NEAR(known(4 * usual_px), 0.1 * 0.1 * (9 + 16 * num_news) / num + model_px2, 1e-9);
  EXPECT_LT(known(0), known(usual_px));
}

TEST(CalibrationState, AnAdjustmentAfterATurnIsNotComparedWithOneBefore) {
  CalibrationState turned = Known(), known = Known();
  turned.Turn({{0, 1e-3, 0}, 1e-8 * Eigen::Matrix3d::Identity()}, 9);
  turned.Learn(Found(Yaw(1), 0.01), 12);
  EXPECT_NEAR(turned.correction().covariance(0, 0), known.correction().covariance(0, 0), 1e-12);
}

double YawOf(const CalibrationState& state) {
  const StereoCorrection::Coefficients per_mrad = Yaw(1);
  return state.correction().mean.coefficients_px.dot(per_mrad) / per_mrad.squaredNorm();
}

TEST(CalibrationState, ATurnIsFollowedAndItsNoiseEndsWithIt) {
  CalibrationState state = Known();
  for (int k = 7; k < 20; ++k) state.Follow(Window(0, k), k);
  const double before = state.correction().covariance(0, 0);
  state.Follow(Window(0.8, 20), 20);
  EXPECT_TRUE(state.IsTurning());
  EXPECT_EQ(state.first_telling(), 16);
  EXPECT_NEAR(YawOf(state), 0.8, 0.1);
  const double during = state.correction().covariance(0, 0);
  EXPECT_GT(during, before + 0.002);
  EXPECT_FALSE(state.Prior()) << "the lens is the same";
  for (int k = 21; k < 40; ++k) {
    state.Follow(Window(0.8, k), k);
    EXPECT_FALSE(state.IsTurning()) << k;
  }
  EXPECT_EQ(state.first_telling(), 16);
  EXPECT_NEAR(YawOf(state), 0.8, 0.05);
  EXPECT_LT(state.correction().covariance(0, 0), before + 0.25 * (during - before));
}

/// 0.14 px: what no observation is trusted to tell, and what a bend makes of a wrong lens.
TEST(CalibrationState, AWindowIsNoSurerThanAnObservation) {
  CalibrationState state = Known();
  for (int k = 7; k < 30; ++k) state.Follow(Found(Yaw(k < 15 ? 0.2 : -0.2), 0.001), k);
  EXPECT_EQ(state.first_telling(), 0);
  EXPECT_EQ(YawOf(state), 0);
}

TEST(CalibrationState, ASlowTurnIsFollowed) {
  CalibrationState state = Known();
  for (int k = 7; k < 60; ++k) {
    const double truth = 0.02 * (k - 6);
    state.Follow(Window(truth, k), k);
    EXPECT_NEAR(YawOf(state), truth, 0.6) << k;
  }
  EXPECT_GT(state.first_telling(), 7);
}

TEST(CalibrationState, AfterATurnOfTheRightCameraTurnsOfTheRoverTellOfTheLensAgain) {
  CalibrationState state = Known();
  state.Follow(Window(0.8, 7), 7);
  state.AddTurn(0.6);
  ASSERT_TRUE(state.Prior());
  EXPECT_NEAR(state.Prior()->mean.coefficients_px[0], state.correction().mean.coefficients_px[0],
              1e-12);
  EXPECT_GT(state.Prior()->covariance(0, 0), 0.5 * Yaw(1)[0] * Yaw(1)[0]);
  EXPECT_LT(state.Prior()->covariance(11, 11), 0.1 * 0.1) << "as the lens was learnt";
}

CorrectionBelief Earlier(double yaw_mrad) {
  CorrectionBelief earlier = CorrectionBelief::Isotropic(0.03);
  earlier.mean.coefficients_px = Yaw(yaw_mrad);
  earlier.is_of_earlier_drive = true;
  return earlier;
}

TEST(CalibrationState, WhatAnEarlierDriveFoundStandsAsLongAsThisOneAllowsIt) {
  CalibrationState state(kCamera, true, Earlier(0.3));
  EXPECT_EQ(state.correction().mean.coefficients_px, Yaw(0.3));
  EXPECT_GT(state.correction().covariance(0, 0), 0.5 * 0.5) << "the cameras may have turned";
  EXPECT_EQ(state.Prior()->covariance, kCalibration.covariance) << "of this drive alone";
  EXPECT_FALSE(state.Learn(Found(Yaw(0.7), 0.3), 3)) << "poses are to be of what stands";
  EXPECT_EQ(state.correction().mean.coefficients_px, Yaw(0.3));
  EXPECT_FALSE(state.Learn(Found(Yaw(0.33), 0.01), 6));
  EXPECT_EQ(state.correction().mean.coefficients_px, Yaw(0.3));
  EXPECT_FALSE(state.Prior());
  EXPECT_LT(state.correction().covariance(0, 0), 0.1 * 0.1);
}

TEST(CalibrationState, WhatAnEarlierDriveFoundGoesWhereThisOneRefutesIt) {
  CalibrationState state(kCamera, true, Earlier(0.3));
  EXPECT_TRUE(state.Learn(Found(Yaw(1.5), 0.1), 3));
  EXPECT_EQ(state.correction().mean.coefficients_px, Yaw(1.5));
  EXPECT_TRUE(state.Learn(Found(Yaw(0.3), 0.02), 6)) << "it does not come back";
}

TEST(CalibrationState, SwitchedOffItStaysAsItIs) {
  for (const CorrectionBelief& known : {CorrectionBelief::OfExactCalibration(), Earlier(0.3)}) {
    CalibrationState state(kCamera, false, known);
    state.AddTurn(2);
    EXPECT_FALSE(state.Prior());
    EXPECT_FALSE(state.WindowPrior(20));
    EXPECT_EQ(state.correction().mean.coefficients_px, known.mean.coefficients_px);
    EXPECT_EQ(state.correction().covariance, known.covariance);
  }
}

}  // namespace
}  // namespace arfm_vo
