#include "base/number_spoiler.h"
#include "pilot_fixture.h"

namespace arfm_vo {
namespace {

TEST_F(PilotTest, WhatTheChassisSaysBlocks) {
  const std::pair<ChassisStatus, StopReason> kCases[] = {
      {{true, false, ChassisAuthority::kUs}, StopReason::kChassisEmergency},
      {{false, true, ChassisAuthority::kUs}, StopReason::kChassisFault},
      {{false, false, ChassisAuthority::kUs, true}, StopReason::kRemoteLost},
      {{false, false, ChassisAuthority::kUs, false, true}, StopReason::kMotorFault},
      {{false, false, ChassisAuthority::kRemoteControl}, StopReason::kRemoteControl},
      {{false, false, ChassisAuthority::kNobody}, StopReason::kModeLost},
      {{false, false, ChassisAuthority::kOther}, StopReason::kModeLost},
  };
  for (const auto& [status, reason] : kCases) {
    pilot_ = Pilot(Options());
    StartDriving();
    chassis_ = status;
    const DriveCommand command = Run(kTick_s);
    EXPECT_TRUE(command.chassis_motion.IsZero());
    EXPECT_TRUE(command.wants_authority);
    EXPECT_EQ(State(), DriveState::kBlocked);
    EXPECT_EQ(Reason(), reason);
    chassis_ = {false, false, ChassisAuthority::kUs};
    EXPECT_TRUE(Run(5).chassis_motion.IsZero()) << "went on without being started";
    pilot_.Start(now_s_);
    EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  }
}

TEST_F(PilotTest, StartIsRefusedWhileTheRemoteControlHasTheRover) {
  chassis_.authority = ChassisAuthority::kRemoteControl;
  Run(0.1);
  const Reply reply = pilot_.Start(now_s_);
  EXPECT_FALSE(reply.is_accepted);
  EXPECT_EQ(reply.text, "not started: remote control has the rover");
  EXPECT_FALSE(Run(0.1).may_speak);
}

TEST_F(PilotTest, ABusThatGoesDownBlocksAndIsNotResumedWithoutStart) {
  StartDriving();
  bus_up_ = false;
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kBusDown);
  EXPECT_FALSE(pilot_.Start(now_s_).is_accepted);
  Run(2);
  way_mm_ += 60;  // it ran out when nothing of it was heard
  bus_up_ = true;
  EXPECT_TRUE(Run(5).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kBusDown);
  pilot_.Start(now_s_);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, ASilentChassisBlocksWhateverItsTracksTell) {
  for (const bool tells_tracks : {false, true}) {
    Remake();
    tells_state_ = tells_tracks_ = true;
    StartDriving();
    tells_state_ = false;
    tells_tracks_ = tells_tracks;
    Run(0.48);
    EXPECT_EQ(State(), DriveState::kDriving) << "0.5 s are allowed";
    Run(0.06);
    EXPECT_EQ(Reason(), StopReason::kNoFeedback);
  }
}

TEST_F(PilotTest, AStartForgetsAJam) {
  Remake([](PilotOptions& options) { options.motion.jam_s = 2; });
  StartDriving();
  Run(1);
  ASSERT_EQ(Reason(), StopReason::kTrackJammed);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  Run(0.5);
  EXPECT_EQ(State(), DriveState::kDriving);
}

TEST_F(PilotTest, RunningTracksUnderAStandingRoverBlock) {
  StartDriving();
  for (int i = 0; i < 500 && State() == DriveState::kDriving; ++i, way_mm_ += 2) Run(kTick_s);
  EXPECT_EQ(Reason(), StopReason::kSlip);
  EXPECT_GT(*pilot_.Status().slip->forward_ratio, 0.9);
  pilot_.ObserveEpoch(2, now_s_);
  EXPECT_FALSE(pilot_.Status().slip);
}

TEST_F(PilotTest, APilotThatWasHeldUpNeedsAStart) {
  StartDriving();
  now_s_ += 0.4;
  EXPECT_FALSE(Run(kTick_s).chassis_motion.IsZero());
  now_s_ += 0.6;
  EXPECT_TRUE(Run(5).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kHeldUp);
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, AHaltByTheGuardIsAPause) {
  StartDriving();
  pilot_.ObserveHalt(now_s_);
  EXPECT_TRUE(Run(0.9).chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kPaused);
  EXPECT_EQ(Reason(), StopReason::kHeldUp);
  EXPECT_TRUE(Run(1.9).chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kWarning);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  pilot_.Stop();
  pilot_.ObserveHalt(now_s_);
  EXPECT_EQ(State(), DriveState::kStandby) << "nothing has moved";
}

TEST_F(PilotTest, CommandsOfAnotherDriverBlock) {
  StartDriving();
  pilot_.chassis_watch().ObserveForeignCommand(now_s_);
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kForeignCommands);
  EXPECT_FALSE(pilot_.Start(now_s_).is_accepted);
  Run(1.1);
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
}

TEST_F(PilotTest, ACreepAtRestBlocksUntilStart) {
  Start();
  Run(2);
  ASSERT_EQ(State(), DriveState::kReady);
  Creep();
  EXPECT_EQ(State(), DriveState::kBlocked);
  EXPECT_EQ(Reason(), StopReason::kMotionAtRest);
  EXPECT_TRUE(Run(5).chassis_motion.IsZero());
  EXPECT_FALSE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  Run(2);
  EXPECT_EQ(State(), DriveState::kReady);
}

TEST_F(PilotTest, ACreepInStandbyIsToldAndTakesNoCommandOfTheChassis) {
  Run(2);
  Creep();
  EXPECT_EQ(State(), DriveState::kStandby);
  EXPECT_EQ(Reason(), StopReason::kMotionAtRest);
  EXPECT_FALSE(Run(kTick_s).may_speak);
}

TEST_F(PilotTest, ACreepOfABlockedRoverIsToldAndOneByTheRemoteControlIsNot) {
  for (const bool is_remote : {true, false}) {
    Remake();
    StartDriving();
    chassis_.is_emergency_stop = true;
    if (is_remote) chassis_.authority = ChassisAuthority::kRemoteControl;
    Run(2);
    Creep();
    EXPECT_EQ(State(), DriveState::kBlocked);
    EXPECT_EQ(Reason(), is_remote ? StopReason::kChassisEmergency : StopReason::kMotionAtRest);
  }
}

TEST_F(PilotTest, AGoalThatWaitedLongBehindABlockIsNotDrivenToLater) {
  for (const double wait_s : {9.0, 11.0}) {
    Remake();
    StartDriving();
    chassis_.is_emergency_stop = true;
    Run(wait_s);
    pilot_.TakeResults();
    chassis_.is_emergency_stop = false;
    Run(0.2);
    ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
    EXPECT_EQ(Run(2).chassis_motion.forward_mps > 0.09, wait_s < 10) << wait_s;
    EXPECT_EQ(pilot_.Status().has_goal, wait_s < 10) << wait_s;
  }
}

TEST_F(PilotTest, TiltIsWarnedOfBelowItsLimit) {
  Run(0.2);
  EXPECT_FALSE(pilot_.Status().is_tilt_near_limit);
  pose_ = Rigid3(ExpSO3({22 * M_PI / 180, 0, 0}), Eigen::Vector3d::Zero());
  Run(0.2);
  EXPECT_TRUE(pilot_.Status().is_tilt_near_limit);
}

TEST(PilotOptions, EachNumberIsChecked) {
  ExpectNumbersAreChecked<PilotOptions>([](const PilotOptions& options) { Pilot{options}; });
}

TEST(PilotOptions, TheCapsAreTheDrivers) {
  const auto take = [](auto&& change) {
    PilotOptions options;
    change(options);
    Pilot{options};
  };
  EXPECT_THROW(take([](auto& o) { o.velocity_timeout_s = 1; }), std::invalid_argument);
  EXPECT_THROW(take([](auto& o) { o.limits.max_speed_mps = 0.5; }), std::invalid_argument);
  EXPECT_THROW(take([](auto& o) { o.goal.cruise_speed_mps = 0.2; }), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
