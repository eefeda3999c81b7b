#include <gtest/gtest.h>

#include <utility>

#include "simulation/simulated_drive.h"

// A pose that is wrong, told to a driver on the CAN bus of a simulated rover.

namespace arfm_vo {
namespace {

constexpr double kMaxWayOnAWrongPose_m = 0.1;

Rigid3 WrongPlaceAt(double x_m, double y_m, double heading_rad = 0) {
  return LiftFromPlane({x_m, y_m, heading_rad});
}

class WrongPoseTest : public ::testing::Test {
 protected:
  /// Drives to `goal` for `duration_s` by a good pose.
  void DriveTo(const Waypoint& goal, double duration_s) {
    drive_.DriveAlong({goal});
    drive_.Run(duration_s);
    ASSERT_EQ(drive_.pilot().Status().state, DriveState::kDriving);
    ASSERT_FALSE(drive_.Commanded().IsZero());
    at_fault_ = drive_.plant().Pose();
  }
  void ExpectToGoOn(double duration_s) {
    drive_.Run(duration_s);
    EXPECT_EQ(drive_.pilot().Status().state, DriveState::kDriving);
  }
  /// The odometry starts anew: from now on the place where the rover stands is told as `told`.
  void RestartOdometryAt(const Rigid3& told) {
    drive_.told_from_true_ = told * drive_.plant().WorldFromBase().Inverse();
  }
  double WayOnTheWrongPose() { return Distance(drive_.plant().Pose(), at_fault_); }
  void ExpectBlocked(StopReason reason) {
    EXPECT_EQ(drive_.pilot().Status().state, DriveState::kBlocked);
    EXPECT_STREQ(ToString(drive_.pilot().Status().reason), ToString(reason));
    EXPECT_LE(WayOnTheWrongPose(), kMaxWayOnAWrongPose_m);
    for (const GoalResult& result : drive_.pilot().TakeResults())
      EXPECT_NE(result.outcome, GoalOutcome::kArrived);
  }

  SimulatedDrive drive_;
  RoverPose at_fault_;
};

TEST_F(WrongPoseTest, OdometryThatRestartsOnTheGoalIsNoArrival) {
  drive_.told_from_true_ = WrongPlaceAt(9, 0);
  DriveTo({0, 0, 0.0}, 3);
  RestartOdometryAt(WrongPlaceAt(0, 0));
  drive_.Run(10);
  ExpectBlocked(StopReason::kPoseContradiction);
  EXPECT_NE(drive_.pilot().Status().detail.find(" m"), std::string::npos);
  EXPECT_FALSE(drive_.HasGoal());
}

TEST_F(WrongPoseTest, AJumpThatIsSeenBeforeItsEpochIsToldIsANewEpoch) {
  DriveTo({6, 0, {}}, 5);
  RestartOdometryAt(WrongPlaceAt(0, 0));
  drive_.Run(0.3);
  ExpectBlocked(StopReason::kPoseContradiction);
  ++drive_.epoch_;
  drive_.Run(0.3);
  ExpectBlocked(StopReason::kNewEpoch);
  EXPECT_FALSE(drive_.HasGoal());
}

TEST_F(WrongPoseTest, ANewEpochExplainsNoOtherStop) {
  DriveTo({6, 0, {}}, 5);
  drive_.pilot().SetEmergencyStop("test", true);
  drive_.Run(0.3);
  ++drive_.epoch_;
  drive_.Run(0.3);
  ExpectBlocked(StopReason::kEmergencyStop);
  EXPECT_FALSE(drive_.HasGoal());
}

TEST_F(WrongPoseTest, TheFirstPoseAfterAPauseMustAgreeWithTheTracks) {
  DriveTo({6, 0, {}}, 5);
  drive_.sigma_m_ = 99.99;
  drive_.Run(1.5);
  ASSERT_EQ(drive_.pilot().Status().state, DriveState::kPaused);
  drive_.sigma_m_ = 0.01;
  RestartOdometryAt(WrongPlaceAt(drive_.plant().Pose().x_m + 0.5, 0));
  drive_.Run(20);
  ExpectBlocked(StopReason::kPoseContradiction);
}

/// What the covariance excuses is not the tracks' slip either; a jump that nothing excuses has its
/// own name, and the goal goes.
TEST_F(WrongPoseTest, AJumpThatTheCovarianceExcusesIsNoSlipAndALargerOneContradicts) {
  DriveTo({6, 0, {}}, 6);
  const double x_m = drive_.plant().Pose().x_m;
  drive_.sigma_m_ = 0.05;
  RestartOdometryAt(WrongPlaceAt(x_m - 0.2, 0));
  ExpectToGoOn(2);
  at_fault_ = drive_.plant().Pose();
  RestartOdometryAt(WrongPlaceAt(x_m - 0.5, 0));
  drive_.Run(1);
  ExpectBlocked(StopReason::kPoseContradiction);
  EXPECT_FALSE(drive_.HasGoal());
}

TEST_F(WrongPoseTest, ASmallStepOfTheMapIsDrivenOnAndALargeOneAsks) {
  const std::pair<Rigid3, Rigid3> kSmallAndLarge[] = {
      {WrongPlaceAt(0.05, 0.05), WrongPlaceAt(0.05, 1)},
      {WrongPlaceAt(0, 0, 0.08), WrongPlaceAt(0, 0, 0.2)}};
  for (const auto& [small, large] : kSmallAndLarge) {
    drive_.map_from_odom_ = {};
    DriveTo({6, 0, {}}, 5);
    drive_.map_from_odom_ = small;
    ExpectToGoOn(2);
    at_fault_ = drive_.plant().Pose();
    drive_.map_from_odom_ = large;
    drive_.Run(8);
    ExpectBlocked(StopReason::kMapStep);
    EXPECT_TRUE(drive_.HasGoal());
    ASSERT_TRUE(drive_.pilot().Start(drive_.Now()).is_accepted);
    ExpectToGoOn(1);
    drive_.pilot().Stop();
  }
}

/// Each step is small: what counts is how far the map has gone since the goal was taken.
TEST_F(WrongPoseTest, AMapThatCreepsAwayAsksToo) {
  DriveTo({6, 0, {}}, 5);
  double off_m = 0;
  for (; off_m < 1 && !drive_.IsBlocked(); off_m += 0.003) {
    drive_.map_from_odom_ = WrongPlaceAt(0, off_m);
    drive_.Run(0.1);
  }
  EXPECT_NEAR(off_m, kMaxMapStep_m, 0.02);
  EXPECT_EQ(drive_.pilot().Status().reason, StopReason::kMapStep);
  ASSERT_TRUE(drive_.pilot().Start(drive_.Now()).is_accepted);
  ExpectToGoOn(1);
}

TEST_F(WrongPoseTest, AMapThatCorrectsWhatTheOdometryHasBecomeUnsureOfIsDrivenOn) {
  DriveTo({6, 0, {}}, 5);
  drive_.sigma_m_ = 0.1;
  drive_.Run(1);
  drive_.map_from_odom_ = WrongPlaceAt(0, 0.4);
  ExpectToGoOn(2);
}

TEST(Fence, ARoverThatTheMapPlacesOutsideItStops) {
  PilotOptions options;
  options.goal_limits.fence_m = {-1, -0.2, 7, -0.2, 7, 2, -1, 2};
  SimulatedDrive drive(options);
  drive.DriveAlong({{6, 0, {}}});
  drive.Run(3);
  ASSERT_EQ(drive.pilot().Status().state, DriveState::kDriving);
  drive.map_from_odom_ = WrongPlaceAt(0, -0.22);  // a step that is allowed
  drive.Run(0.3);
  EXPECT_TRUE(drive.IsBlocked());
  EXPECT_STREQ(ToString(drive.pilot().Status().reason), ToString(StopReason::kOutsideFence));
}

TEST_F(WrongPoseTest, APoseThatCreepsAwayWhileTheTracksStandIsSliding) {
  drive_.Run(0.5);
  ASSERT_TRUE(drive_.pilot().Start(drive_.Now()).is_accepted);
  drive_.Run(1);
  drive_.each_tick_ = [this] {
    drive_.told_from_true_ = WrongPlaceAt(0, 0.001) * drive_.told_from_true_;
  };
  drive_.Run(5);
  EXPECT_EQ(drive_.pilot().Status().reason, StopReason::kSliding);
}

/// A baseline that is too short in the calibration, or tracks that slip where they should not.
TEST_F(WrongPoseTest, SightThatIsAQuarterShorterThanTheTracksStopsAfterFiveMetres) {
  for (const double slip : {0.15, 0.25}) {
    SimulatedDrive drive;
    drive.plant().SetForwardSlip(slip);
    drive.DriveAlong({{8, 0, {}}});
    const bool is_too_short = slip > SlipOptions().max_level_ratio;
    EXPECT_EQ(drive.RunUntil(150, [&] { return drive.IsBlocked(); }), is_too_short);
    if (!is_too_short) continue;
    EXPECT_EQ(drive.pilot().Status().reason, StopReason::kSlip);
    EXPECT_NE(drive.pilot().Status().detail.find("tracks 5.0"), std::string::npos);
    EXPECT_LT(drive.plant().Pose().x_m, 5.2 * (1 - slip));
  }
}

}  // namespace
}  // namespace arfm_vo
