#include "pilot_fixture.h"

namespace arfm_vo {
namespace {

TEST_F(PilotTest, HoweverFreshTheGoalAMotionAfterAPauseIsWarnedOf) {
  StartDriving();
  pilot_.SetRoute({{5, 0, {}}});
  Run(0.1);
  sigma_m_ = 100;
  EXPECT_TRUE(Run(0.1).chassis_motion.IsZero());
  ASSERT_EQ(State(), DriveState::kPaused);
  sigma_m_ = 0.01;
  Run(Options().resume_after_s + 0.1);
  EXPECT_EQ(State(), DriveState::kWarning);
  EXPECT_TRUE(Run(Options().warning_s - 0.2).chassis_motion.IsZero());
  EXPECT_FALSE(Run(0.5).chassis_motion.IsZero());
}

TEST_F(PilotTest, ACommandThatTheChassisWaitedLongWithIsWarnedOf) {
  Remake([](PilotOptions& options) {
    options.fresh_command_s = 1;
    options.arming_timeout_s = 5;
  });
  Run(0.1);
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  Run(1.5);
  chassis_.authority = ChassisAuthority::kUs;
  EXPECT_TRUE(Run(0.1).chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kWarning);
}

TEST_F(PilotTest, AStalePosePausesAndAGoodOneResumesAfterAWarning) {
  StartDriving();
  has_pose_ = false;
  Run(0.88);
  EXPECT_EQ(State(), DriveState::kDriving);
  EXPECT_TRUE(Run(0.06).chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kPaused);
  EXPECT_EQ(Reason(), StopReason::kPoseStale);
  has_pose_ = true;
  DriveCommand command = Run(0.9);
  EXPECT_TRUE(command.chassis_motion.IsZero());
  EXPECT_FALSE(command.is_lamp_on);
  command = Run(0.2);
  EXPECT_EQ(State(), DriveState::kWarning);
  EXPECT_TRUE(command.chassis_motion.IsZero());
  EXPECT_TRUE(command.is_lamp_on);
  EXPECT_TRUE(Run(1.8).chassis_motion.IsZero());
  EXPECT_GT(Run(1).chassis_motion.forward_mps, 0.05);
}

TEST_F(PilotTest, AStartWhileItWarnsMovesAtOnce) {
  StartDriving();
  has_pose_ = false;
  Run(1.5);
  has_pose_ = true;
  Run(1.1);
  ASSERT_EQ(State(), DriveState::kWarning);
  pilot_.Start(now_s_);
  EXPECT_GT(Run(1).chassis_motion.forward_mps, 0.05);
}

TEST_F(PilotTest, APoseThatFlickersDoesNotMoveTheRover) {
  StartDriving();
  for (int i = 0; i < 20; ++i) {
    pilot_.ObserveNoPose();
    has_pose_ = false;
    Run(kTick_s);
    has_pose_ = true;
    EXPECT_TRUE(Run(0.8).chassis_motion.IsZero());
  }
}

TEST_F(PilotTest, ALongPauseNeedsANewStart) {
  StartDriving();
  has_pose_ = false;
  Run(4.1);
  EXPECT_EQ(State(), DriveState::kBlocked);
  EXPECT_EQ(Reason(), StopReason::kPoseLost);
  has_pose_ = true;
  EXPECT_TRUE(Run(5).chassis_motion.IsZero());
  pilot_.Start(now_s_);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, AnUncertainHeadingPauses) {
  StartDriving();
  heading_sigma_rad_ = 0.4;
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kPoseUncertain);
}

TEST_F(PilotTest, APoseWithoutCovarianceOrEpochIsNotDrivenBy) {
  for (const StopReason reason : {StopReason::kPoseUncertain, StopReason::kEpochMissing}) {
    Remake();
    has_covariance_ = reason != StopReason::kPoseUncertain;
    has_epoch_ = reason != StopReason::kEpochMissing;
    Start();
    Run(kTick_s);
    EXPECT_EQ(Reason(), reason);
  }
}

TEST_F(PilotTest, AnUncertaintyThatHasGrownIsMeasuredFromTheDatumThatAPersonConfirms) {
  StartDriving();
  sigma_m_ = 2.1;
  Run(0.5);
  EXPECT_EQ(Reason(), StopReason::kPoseUncertain);
  Run(4);
  EXPECT_EQ(State(), DriveState::kBlocked);
  EXPECT_TRUE(pilot_.SetDatum().is_accepted);
  pilot_.Start(now_s_);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  EXPECT_FALSE(pilot_.SetDatum().is_accepted) << "while driving";
}

TEST_F(PilotTest, AnUncertaintyThatFallsBelowItsDatumDoesNotStopTheRover) {
  StartDriving();
  sigma_m_ = 3;
  Run(0.5);
  ASSERT_EQ(Reason(), StopReason::kPoseUncertain);
  ASSERT_TRUE(pilot_.SetDatum().is_accepted);
  pilot_.Start(now_s_);
  ASSERT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  sigma_m_ = 2.5;
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, APersonConfirmsAnUncertainPoseThatTheRoverWasStartedWith) {
  sigma_m_ = 2.1;
  Run(0.1);
  chassis_.authority = ChassisAuthority::kUs;
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  Run(1);
  ASSERT_EQ(Reason(), StopReason::kPoseUncertain);
  EXPECT_TRUE(pilot_.SetDatum().is_accepted);
  Run(2);
  EXPECT_EQ(State(), DriveState::kReady);
}

TEST_F(PilotTest, ALostPoseIsNoDatum) {
  StartDriving();
  sigma_m_ = std::sqrt(9999);
  Run(5);
  EXPECT_FALSE(pilot_.SetDatum().is_accepted);
}

TEST_F(PilotTest, WhatTheTracksWentSinceALatePoseCounts) {
  StartDriving();
  has_pose_ = false;
  way_mm_ = 90;
  Run(0.5);
  EXPECT_NEAR(pilot_.Status().distance_to_goal_m, 5 - 0.09, 1e-9);
  // One from before the tracks went.
  pilot_.ObservePose(now_s_, {now_s_ - 0.55, pose_, {}});
  pilot_.ObserveUncertainty(now_s_, {now_s_ - 0.55, sigma_m_, heading_sigma_rad_});
  pilot_.Tick(now_s_ + kTick_s);
  EXPECT_NEAR(pilot_.Status().distance_to_goal_m, 5 - 0.09, 1e-9);
}

}  // namespace
}  // namespace arfm_vo
