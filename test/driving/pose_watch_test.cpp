#include "arfm_vo/driving/pose_watch.h"

#include <gtest/gtest.h>

#include <cmath>

namespace arfm_vo {
namespace {

Rigid3 SightingAt(double x_m, double y_m = 0, double heading_rad = 0) {
  return {ExpSO3({0, 0, heading_rad}), Eigen::Vector3d(x_m, y_m, 0)};
}

class PoseWatchTest : public ::testing::Test {
 protected:
  PoseWatchTest() { watch_.ObserveEpoch(1, 10); }

  void Drive(double now_s, double way_m) {
    const int way_mm = static_cast<int>(std::lround(1000 * way_m));
    tracks_.Add(now_s, way_mm, way_mm);
  }
  /// Tells a sighting and its covariance, and judges it.
  std::optional<Fault> See(double now_s, const Rigid3& pose, double sigma_m = 0.01) {
    watch_.Observe(now_s, PoseUncertainty{now_s, sigma_m, 0.01});
    watch_.Observe(now_s, PoseObservation{now_s, pose, {}});
    return watch_.Judge(now_s, tracks_);
  }

  PoseWatch watch_{PoseWatchOptions{}, TrackKinematics({})};
  TrackHistory tracks_{2};
};

TEST_F(PoseWatchTest, ASightingCountsOnceItsCovarianceHasCome) {
  Drive(10, 0);
  EXPECT_FALSE(See(10, SightingAt(0)));
  watch_.Observe(10.5, PoseObservation{10.5, SightingAt(3), {}});
  EXPECT_FALSE(watch_.Judge(10.5, tracks_));
  EXPECT_EQ(watch_.LastSighting().taken_s, 10) << "judged without its covariance";
  watch_.Observe(10.6, PoseUncertainty{10.5, 0.01, 0.01});
  EXPECT_EQ(watch_.Judge(10.6, tracks_)->reason, StopReason::kPoseContradiction);
}

TEST_F(PoseWatchTest, AMapThatTiltsIsNoticedBeforeTheNextSighting) {
  Drive(10, 0);
  See(10, SightingAt(0));
  EXPECT_FALSE(watch_.IsTilted());
  const Rigid3 tilted(ExpSO3({0.6, 0, 0}), Eigen::Vector3d::Zero());
  watch_.Observe(10.1, PoseObservation{10, SightingAt(0), tilted});
  watch_.Judge(10.1, tracks_);
  EXPECT_TRUE(watch_.IsTilted());
}

TEST_F(PoseWatchTest, ACovarianceFromTheFutureIsNotTaken) {
  EXPECT_TRUE(watch_.Observe(10, PoseUncertainty{10, 0.01, 0.01}));
  for (const double later_s : {11.0, 1e9, static_cast<double>(NAN)})
    EXPECT_FALSE(watch_.Observe(10, PoseUncertainty{later_s, 0.01, 0.01})) << later_s;
}

TEST_F(PoseWatchTest, ANewEpochHasNoPoseYet) {
  Drive(10, 0);
  See(10, SightingAt(0));
  ASSERT_FALSE(watch_.FindFault(10));
  EXPECT_TRUE(watch_.ObserveEpoch(2, 10.1));
  EXPECT_EQ(watch_.FindFault(10.1), StopReason::kPoseMissing);
}

TEST_F(PoseWatchTest, ACovarianceOfAnotherEpochSaysNothingOfThisOne) {
  EXPECT_TRUE(watch_.Observe(10, PoseUncertainty{10.2, 0.01, 0.01}));
  EXPECT_TRUE(watch_.ObserveEpoch(2, 10.1));
  watch_.Observe(10.1, PoseObservation{10.1, SightingAt(0), {}});
  watch_.Judge(10.1, tracks_);
  EXPECT_EQ(watch_.FindFault(10.1), StopReason::kPoseUncertain);
}

TEST(PoseConsistency, SidewaysIsAcrossTheMiddleOfATurn) {
  const PoseConsistency consistency(TrackKinematics({}));
  const TrackedSighting earlier{0, {}, 0, 0, {}};
  const TrackWays ways{0.2, 0.6};
  RoverPose ahead = consistency.Predict(earlier, ways);
  ASSERT_GT(ahead.heading_rad, 0.3);
  ahead.x_m += 0.1 * std::cos(ahead.heading_rad / 2);
  ahead.y_m += 0.1 * std::sin(ahead.heading_rad / 2);
  EXPECT_NEAR(consistency.Compare(earlier, {1, ahead, 0, 0, ways}).sideways_m, 0, 1e-12);
}

TEST(PoseConsistency, TheFasterTrackSaysHowMuchMaySlip) {
  const PoseConsistency consistency(TrackKinematics({}));
  const TrackedSighting earlier{0, {}, 0, 0, {}};
  for (const TrackWays& ways : {TrackWays{0, 0.5}, TrackWays{0.5, 0}}) {
    const auto difference = consistency.Compare(earlier, {1, {}, 0, 0, ways});
    EXPECT_NEAR(difference.max_distance_m, kMaxPoseError_m + 0.5 * kMaxSlipRatio, 1e-12);
  }
}

TEST_F(PoseWatchTest, ACreepThatIsSlowerThanTheWindowIsNoSlide) {
  for (int i = 0; i < 6; ++i) {
    const double now_s = 10 + kSlideWindow_s * i;
    Drive(now_s, 0);
    EXPECT_FALSE(See(now_s, SightingAt(0, 0.4 * kMaxPoseError_m * i))) << i;
  }
}

TEST_F(PoseWatchTest, AgreesWithTracksThatSlip) {
  Drive(10, 0);
  See(10, SightingAt(0));
  Drive(11, 0.1);
  EXPECT_FALSE(See(11, SightingAt(0.09)));
  Drive(12, 0.2);
  EXPECT_FALSE(See(12, SightingAt(0.1)));
}

TEST_F(PoseWatchTest, AJumpIsMeasuredAgainstTheTracks) {
  Drive(10, 0);
  See(10, SightingAt(0));
  Drive(11, 0.1);
  const auto fault = See(11, SightingAt(0.1 + 0.5));
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->detail.rfind("off the tracks by 0.50 m (allowed 0.20 m)", 0), 0u)
      << fault->detail;
  EXPECT_FALSE(See(11.5, SightingAt(0.6))) << "the next is compared with the one that has jumped";
}

TEST_F(PoseWatchTest, ACovarianceThatHasGrownAllowsMoreButNotAnything) {
  Drive(10, 0);
  See(10, SightingAt(0), 0.01);
  EXPECT_FALSE(See(11, SightingAt(0.25), 0.1)) << "3 sigma of 0.1 m";
  EXPECT_TRUE(See(12, SightingAt(1.25), 1.5)) << "a covariance excuses 0.3 m at most";
}

TEST_F(PoseWatchTest, ACorrectionWithinTheFormerCovarianceIsNoContradiction) {
  Drive(10, 0);
  See(10, SightingAt(0), 0.1);
  EXPECT_FALSE(See(11, SightingAt(0.25), 0.01));
}

TEST_F(PoseWatchTest, ASightingThatIsUncertainIsNotComparedWith) {
  Drive(10, 0);
  See(10, SightingAt(0));
  EXPECT_FALSE(See(10.5, SightingAt(7), 99.99));
  EXPECT_EQ(watch_.LastSighting().taken_s, 10);
  EXPECT_EQ(See(11, SightingAt(7))->reason, StopReason::kPoseContradiction);
}

TEST_F(PoseWatchTest, ASidewaysStepIsLessExcusedThanOneAhead) {
  Drive(10, 0);
  See(10, SightingAt(0, 0, M_PI / 2));
  Drive(11, 0.1);
  EXPECT_FALSE(See(11, SightingAt(0, 0.28, M_PI / 2)));
  EXPECT_TRUE(See(11.5, SightingAt(0.18, 0.28, M_PI / 2)));
}

TEST_F(PoseWatchTest, SightingsFromBeforeANewEpochDoNotCount) {
  Drive(10, 0);
  See(10, SightingAt(5));
  EXPECT_TRUE(watch_.ObserveEpoch(2, 11));
  EXPECT_FALSE(See(10.9, SightingAt(5)));
  EXPECT_FALSE(watch_.HasPose());
  EXPECT_FALSE(See(11, SightingAt(0)));
  EXPECT_TRUE(watch_.HasPose());
}

TEST_F(PoseWatchTest, ADatumCountsInItsEpochOnly) {
  Drive(10, 0);
  See(10, SightingAt(0), 3);
  ASSERT_TRUE(watch_.SetDatum());
  EXPECT_FALSE(watch_.FindFault(10).value_or(StopReason::kPoseMissing) ==
               StopReason::kPoseUncertain);
  EXPECT_TRUE(watch_.ObserveEpoch(2, 11));
  See(11, SightingAt(0), 3);
  EXPECT_EQ(watch_.FindFault(11), StopReason::kPoseUncertain);
}

}  // namespace
}  // namespace arfm_vo
