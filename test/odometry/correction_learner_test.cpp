#include "arfm_vo/odometry/correction_learner.h"

#include <gtest/gtest.h>

namespace arfm_vo {
namespace {

constexpr int kFirstRow = StereoCorrection::kNumPlacing;
const StereoCamera kCamera{400, 400, 320, 240, 0.3, 640, 480};

/// A keyframe whose right rows are `off_px` below the left ones.
Keyframe SeeRowsOff(double off_px) {
  Keyframe keyframe;
  for (int i = 0; i < 20; ++i) {
    const double u = 100 + 20 * i, v = 40 + 20 * i;
    keyframe.observations.push_back({{{u, v, u - 10, v + off_px}, true, 0.2}, i});
  }
  return keyframe;
}

BundleResult Found(double column_px, double sigma_px, BundleStatus status) {
  BundleResult result;
  result.status = status;
  result.correction.coefficients_px[0] = column_px;
  result.correction_covariance.setIdentity();
  result.correction_covariance *= sigma_px * sigma_px;
  return result;
}

CorrectionLearner KnowingLearner(bool may_learn = true) {
  return {kCamera, may_learn, CorrectionBelief::Isotropic(0.01)};
}

TEST(CorrectionLearner, WhatIsKnownIsHeldAndWhatIsNotIsLearnt) {
  EXPECT_FALSE(KnowingLearner().Prior());
  const CorrectionBelief calibration = CorrectionBelief::OfCalibration(kCamera);
  EXPECT_TRUE(CorrectionLearner(kCamera, true, calibration).Prior());
  EXPECT_FALSE(CorrectionLearner(kCamera, false, calibration).Prior());
}

/// With 0.2 px in the columns from an earlier drive.
CorrectionLearner RememberingLearner(bool may_learn = true) {
  CorrectionBelief earlier = CorrectionBelief::Isotropic(0.01);
  earlier.mean.coefficients_px[0] = 0.2;
  earlier.is_of_earlier_drive = true;
  return {kCamera, may_learn, earlier};
}

TEST(CorrectionLearner, WhatAnEarlierDriveToldIsHeldOnceThisOneFindsTheSame) {
  CorrectionLearner learner = RememberingLearner();
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.2);
  EXPECT_GT(learner.correction().covariance(0, 0), 0.1) << "it may have changed";
  ASSERT_TRUE(learner.Prior());
  EXPECT_TRUE(learner.Learn(Found(0.4, 0.3, BundleStatus::kConverged)));
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.2) << "stands, as far as that tells";
  EXPECT_GT(learner.correction().covariance(0, 0), 0.1);
  ASSERT_TRUE(learner.Prior());
  EXPECT_TRUE(learner.Learn(Found(0.22, 0.01, BundleStatus::kConverged)));
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.2);
  EXPECT_LT(learner.correction().covariance(0, 0), 0.06 * 0.06);
  EXPECT_FALSE(learner.Prior());
  learner.AddTurn(0.6);
  learner.LearnFromTurns();
  EXPECT_NEAR(learner.Prior()->covariance(0, 0), 1e-4, 1e-12) << "as the earlier drive told";
}

TEST(CorrectionLearner, WhatAnEarlierDriveToldIsDroppedWhereThisOneFindsAnother) {
  CorrectionLearner learner = RememberingLearner();
  EXPECT_FALSE(learner.Learn(Found(0.6, 0.03, BundleStatus::kConverged)));
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.6);
  EXPECT_FALSE(learner.Prior()) << "0.03 px is known";
  learner.AddTurn(0.6);
  learner.LearnFromTurns();
  EXPECT_FALSE(learner.Learn(Found(0.2, 0.03, BundleStatus::kConverged)));
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.2);
}

TEST(CorrectionLearner, WhereNothingIsToBeLearntWhatAnEarlierDriveToldIsHeld) {
  CorrectionLearner learner = RememberingLearner(false);
  EXPECT_FALSE(learner.Prior());
  EXPECT_NEAR(learner.correction().covariance(0, 0), 1e-4, 1e-12);
}

TEST(CorrectionLearner, LearnsUntilItIsKnown) {
  CorrectionLearner learner(kCamera, true, CorrectionBelief::OfCalibration(kCamera));
  learner.Learn(Found(0.3, 0.3, BundleStatus::kConverged));
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.3);
  EXPECT_TRUE(learner.Prior());  // 0.3 px are not known well
  learner.Learn(Found(0.2, 0.001, BundleStatus::kNotConverged));
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.2);
  EXPECT_FALSE(learner.Prior());
  learner.Learn(Found(0.9, 0.001, BundleStatus::kConverged));  // held
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0.2);
}

TEST(CorrectionLearner, WhatIsLearntIsNeverSurerThanItsModel) {
  CorrectionLearner learner(kCamera, true, CorrectionBelief::OfCalibration(kCamera));
  learner.Learn(Found(0.2, 1e-6, BundleStatus::kConverged));
  EXPECT_NEAR(learner.correction().covariance(0, 0), 0.05 * 0.05, 1e-9);
}

TEST(CorrectionLearner, AnAdjustmentThatEndedEarlySaysNothing) {
  CorrectionLearner learner(kCamera, true, CorrectionBelief::OfCalibration(kCamera));
  learner.Learn(Found(0.3, 0.01, BundleStatus::kCancelled));
  BundleResult without_covariance = Found(0.3, 0, BundleStatus::kConverged);
  learner.Learn(without_covariance);
  EXPECT_EQ(learner.correction().mean.coefficients_px[0], 0);
  EXPECT_TRUE(learner.Prior());
}

TEST(CorrectionLearner, TenKeyframesInARowWhoseRowsContradictBeginAnew) {
  CorrectionLearner learner = KnowingLearner();
  for (int k = 0; k < 9; ++k) learner.CheckRows(SeeRowsOff(0.6), k);
  learner.CheckRows(SeeRowsOff(0.1), 9);
  for (int k = 10; k < 19; ++k) learner.CheckRows(SeeRowsOff(0.6), k);
  EXPECT_FALSE(learner.Prior());
  EXPECT_EQ(learner.first_telling(), 0);
  learner.CheckRows(SeeRowsOff(0.6), 19);
  ASSERT_TRUE(learner.Prior());
  EXPECT_EQ(learner.first_telling(), 9);
  EXPECT_EQ(learner.Prior()->covariance, CorrectionBelief::OfCalibration(kCamera).covariance);
  EXPECT_EQ(learner.correction().covariance, learner.Prior()->covariance);
}

TEST(CorrectionLearner, RowsThatTheCorrectionExplainsDoNotContradict) {
  CorrectionBelief known = CorrectionBelief::Isotropic(0.01);
  known.mean.coefficients_px[kFirstRow] = 0.8;
  CorrectionLearner learner(kCamera, true, known);
  for (int k = 0; k < 30; ++k) learner.CheckRows(SeeRowsOff(0.8), k);
  EXPECT_FALSE(learner.Prior());
  for (int k = 30; k < 40; ++k) learner.CheckRows(SeeRowsOff(-0.8), k);
  EXPECT_TRUE(learner.Prior());
}

TEST(CorrectionLearner, KeyframesOfTheLeftImageAloneNeitherContradictNorAgree) {
  CorrectionLearner learner = KnowingLearner();
  Keyframe left_alone = SeeRowsOff(0);
  for (LandmarkObservation& seen : left_alone.observations) seen.has_right = false;
  for (int k = 0; k < 10; ++k) {
    learner.CheckRows(SeeRowsOff(0.6), 2 * k);
    learner.CheckRows(left_alone, 2 * k + 1);
  }
  EXPECT_TRUE(learner.Prior());
}

TEST(CorrectionLearner, TurnsTellMoreAndOnlyOnce) {
  CorrectionLearner learner = KnowingLearner();
  learner.AddTurn(0.49);
  learner.LearnFromTurns();
  EXPECT_FALSE(learner.Prior());
  learner.AddTurn(0.02);
  learner.LearnFromTurns();
  EXPECT_TRUE(learner.Prior());
  learner.Learn(Found(0.1, 0.001, BundleStatus::kConverged));
  learner.LearnFromTurns();
  EXPECT_FALSE(learner.Prior());
  learner.AddTurn(0.51);
  learner.LearnFromTurns();
  EXPECT_TRUE(learner.Prior());
  learner.Hold();
  EXPECT_FALSE(learner.Prior());
}

TEST(CorrectionLearner, SwitchedOffItNeverLearns) {
  CorrectionLearner learner = KnowingLearner(false);
  for (int k = 0; k < 20; ++k) learner.CheckRows(SeeRowsOff(0.8), k);
  learner.AddTurn(9);
  learner.LearnFromTurns();
  EXPECT_FALSE(learner.Prior());
}

}  // namespace
}  // namespace arfm_vo
