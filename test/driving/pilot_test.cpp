#include "arfm_vo/driving/pilot.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace arfm_vo {
namespace {

constexpr double kTick_s = 0.02;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A pilot whose pose, chassis and bus are well unless a test says otherwise. The rover itself does
/// not move: what counts is what the pilot commands.
class PilotTest : public ::testing::Test {
 protected:
  static PilotOptions Options() {
    PilotOptions options;
    options.max_stall_s = 1e9;
    options.motion.jam_s = 3600;  // its tracks stand
    return options;
  }

  void Observe() {
    if (bus_up_) {
      pilot_.ObserveChassis(now_s_, chassis_);
      pilot_.ObserveTracks(now_s_, way_mm_, way_mm_);
    }
    pilot_.ObserveBus(bus_up_);
    if (has_operator_) pilot_.ObserveOperator(now_s_);
    pilot_.ObserveEpoch(1, now_s_ - 0.1);
    if (has_pose_) pilot_.ObservePose(now_s_, {now_s_ - 0.1, pose_, {}});
    if (has_pose_) pilot_.ObserveUncertainty(now_s_, {now_s_ - 0.1, sigma_m_, heading_sigma_rad_});
  }

  DriveCommand Run(double duration_s) {
    DriveCommand command;
    const int num_ticks = static_cast<int>(std::round(duration_s / kTick_s));
    for (int i = 0; i < num_ticks; ++i) {
      now_s_ += kTick_s;
      Observe();
      command = pilot_.Tick(now_s_);
    }
    return command;
  }

  /// Started and driving at a goal 5 m ahead.
  void StartDriving() {
    Run(0.1);
    chassis_.authority = ChassisAuthority::kUs;
    ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
    pilot_.SetRoute({{5, 0, {}}});
    ASSERT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  }

  /// Started in the mode that stops after each step to look.
  void StartStopLookGo() {
    PilotOptions options = Options();
    options.stop_look_go.is_on = true;
    pilot_ = Pilot(options);
    chassis_.authority = ChassisAuthority::kUs;
    Run(0.1);
    ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  }

  DriveState State() const { return pilot_.Status().state; }
  StopReason Reason() const { return pilot_.Status().reason; }

  Pilot pilot_{Options()};
  double now_s_ = 100;
  ChassisStatus chassis_;
  bool bus_up_ = true, has_pose_ = true, has_operator_ = true;
  Rigid3 pose_;
  int way_mm_ = 0;  ///< of the tracks
  double sigma_m_ = 0.01, heading_sigma_rad_ = 0.01;
};

TEST_F(PilotTest, SaysNothingAndMovesNothingBeforeStart) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  for (int i = 0; i < 100; ++i) {
    const DriveCommand command = Run(kTick_s);
    EXPECT_FALSE(command.may_speak);
    EXPECT_FALSE(command.wants_authority);
    EXPECT_TRUE(command.chassis_motion.IsZero());
  }
  EXPECT_EQ(State(), DriveState::kStandby);
  EXPECT_EQ(Reason(), StopReason::kNotStarted);
}

TEST_F(PilotTest, AGoalSentShortlyBeforeStartIsDrivenToAfterIt) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  Run(9);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, ALongStandbyTakesAndKeepsNoGoal) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  Run(10.1);
  EXPECT_EQ(pilot_.TakeResults().at(0).outcome, GoalOutcome::kCancelled);
  EXPECT_FALSE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_TRUE(Run(2).chassis_motion.IsZero());
  EXPECT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, GoalsThatAreTooFarOrComeWhileBlockedAreRefused) {
  StartDriving();
  EXPECT_EQ(pilot_.SetRoute({{50.1, 0, {}}}).text,
            "goal refused: it is 50.1 m away, farther than 50.0 m");
  EXPECT_NEAR(pilot_.Status().distance_to_goal_m, 5, 1e-9);
  pilot_.SetEmergencyStop("test", true);
  Run(kTick_s);
  EXPECT_EQ(pilot_.SetRoute({{1, 0, {}}}).text,
            "goal refused: the rover is blocked: software emergency stop is set by test");
}

TEST_F(PilotTest, AGoalWithoutAPoseIsRefused) {
  has_pose_ = false;
  Run(0.1);
  EXPECT_EQ(pilot_.SetRoute({{5, 0, {}}}).text, "goal refused: the rover has no pose");
}

TEST_F(PilotTest, AGoalRightAfterANewEpochIsRefused) {
  Run(0.1);
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  pilot_.ObserveEpoch(2, now_s_);
  EXPECT_EQ(pilot_.SetRoute({{5, 0, {}}}).text, "goal refused: the rover has no pose");
}

TEST_F(PilotTest, WithoutAnOperatorTheRoverStopsWithinASecondAndNeedsAStart) {
  StartDriving();
  has_operator_ = false;
  EXPECT_FALSE(Run(0.8).chassis_motion.IsZero());
  EXPECT_TRUE(Run(0.2).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kOperatorLost);
  EXPECT_FALSE(pilot_.Start(now_s_).is_accepted);
  has_operator_ = true;
  EXPECT_TRUE(Run(5).chassis_motion.IsZero()) << "went on without being started";
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, WaitsForTheChassisToTakeCommands) {
  Run(0.1);
  pilot_.SetRoute({{5, 0, {}}});
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
  const DriveCommand command = Run(1);
  EXPECT_TRUE(command.may_speak);
  EXPECT_TRUE(command.wants_authority);
  EXPECT_TRUE(command.chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kArming);
  Run(2);
  EXPECT_EQ(State(), DriveState::kBlocked);
  EXPECT_EQ(Reason(), StopReason::kModeLost);
}

TEST_F(PilotTest, StopWinsAndDropsTheGoal) {
  StartDriving();
  pilot_.Stop();
  const DriveCommand command = Run(kTick_s);
  EXPECT_TRUE(command.chassis_motion.IsZero());
  EXPECT_TRUE(command.may_speak);
  EXPECT_FALSE(command.wants_authority);
  const auto results = pilot_.TakeResults();
  ASSERT_EQ(results.size(), 1u);
  EXPECT_EQ(results[0].outcome, GoalOutcome::kCancelled);
  EXPECT_EQ(results[0].reason, StopReason::kStopped);
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_TRUE(Run(2).chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kReady);
}

TEST_F(PilotTest, CancelStopsAtOnce) {
  StartDriving();
  EXPECT_EQ(pilot_.Status().phase, DrivePhase::kDrive);
  pilot_.CancelRoute();
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kReady);
  const GoalResult result = pilot_.TakeResults().at(0);
  EXPECT_EQ(result.outcome, GoalOutcome::kCancelled);
  EXPECT_NEAR(result.position_error_m, 5, 1e-9);
}

TEST_F(PilotTest, WhatStoppedItIsNotSaidAnyLonger) {
  StartDriving();
  pilot_.SetEmergencyStop("joystick", true);
  Run(kTick_s);
  ASSERT_EQ(pilot_.Status().detail, "by joystick");
  pilot_.Stop();
  EXPECT_EQ(Reason(), StopReason::kStopped);
  EXPECT_EQ(pilot_.Status().detail, "");
  pilot_.SetEmergencyStop("joystick", false);
  chassis_.authority = ChassisAuthority::kNobody;
  Run(kTick_s);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_EQ(State(), DriveState::kArming);
  EXPECT_EQ(Reason(), StopReason::kNone);
  chassis_.authority = ChassisAuthority::kUs;
  has_pose_ = false;
  Run(1.2);
  ASSERT_EQ(Reason(), StopReason::kPoseStale);
  has_pose_ = true;
  Run(2);
  EXPECT_EQ(Reason(), StopReason::kNone);
}

TEST_F(PilotTest, EmergencyStopBlocksUntilReleasedAndStarted) {
  StartDriving();
  pilot_.SetEmergencyStop("joystick", true);
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kEmergencyStop);
  EXPECT_EQ(pilot_.TakeResults().at(0).outcome, GoalOutcome::kBlocked);
  EXPECT_FALSE(pilot_.Start(now_s_).is_accepted);
  pilot_.SetEmergencyStop("joystick", false);
  EXPECT_TRUE(Run(5).chassis_motion.IsZero());
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, AnEmergencyStopIsClearedByNobodyButItsSourceOrAPerson) {
  StartDriving();
  pilot_.SetEmergencyStop("joystick", true);
  pilot_.SetEmergencyStop("panel", true);
  pilot_.SetEmergencyStop("other", false);
  pilot_.SetEmergencyStop("panel", false);
  EXPECT_EQ(pilot_.Start(now_s_).text, "not started: software emergency stop is set by joystick");
  pilot_.ReleaseEmergencyStops();
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
}

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
  PilotOptions options = Options();
  options.fresh_command_s = 1;
  options.arming_timeout_s = 5;
  pilot_ = Pilot(options);
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

TEST_F(PilotTest, AnUncertainPosePauses) {
  for (const double sigma_m : {2.1, 99.99, kNaN}) {
    pilot_ = Pilot(Options());
    sigma_m_ = 0.01;
    StartDriving();
    sigma_m_ = sigma_m;
    EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero()) << sigma_m;
    EXPECT_EQ(Reason(), StopReason::kPoseUncertain);
  }
}

TEST_F(PilotTest, AnUncertainHeadingPauses) {
  StartDriving();
  heading_sigma_rad_ = 0.4;
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kPoseUncertain);
}

TEST_F(PilotTest, APoseWithoutCovarianceIsNotTrusted) {
  pilot_.ObserveChassis(now_s_, {false, false, ChassisAuthority::kUs});
  pilot_.ObserveTracks(now_s_, 0, 0);
  pilot_.ObserveOperator(now_s_);
  pilot_.ObserveEpoch(1, now_s_);
  pilot_.ObservePose(now_s_, {now_s_, pose_, {}});
  pilot_.Start(now_s_);
  pilot_.Tick(now_s_);
  EXPECT_EQ(Reason(), StopReason::kPoseUncertain);
}

TEST_F(PilotTest, APoseWithoutEpochIsNotDrivenBy) {
  pilot_.ObserveChassis(now_s_, {false, false, ChassisAuthority::kUs});
  pilot_.ObserveTracks(now_s_, 0, 0);
  pilot_.ObserveOperator(now_s_);
  pilot_.ObservePose(now_s_, {now_s_, pose_, {}});
  pilot_.ObserveUncertainty(now_s_, {now_s_, 0.01, 0.01});
  pilot_.Start(now_s_);
  pilot_.Tick(now_s_);
  EXPECT_EQ(Reason(), StopReason::kEpochMissing);
}

TEST_F(PilotTest, ACovarianceFromTheFutureIsNotTaken) {
  StartDriving();
  has_pose_ = false;
  EXPECT_FALSE(pilot_.ObserveUncertainty(now_s_, {now_s_ + 1e9, 0.01, 0.01}));
  EXPECT_FALSE(pilot_.ObserveUncertainty(now_s_, {kNaN, 0.01, 0.01}));
  for (int i = 0; i < 60; ++i) {
    now_s_ += kTick_s;
    Observe();
    pilot_.ObservePose(now_s_, {now_s_ - 0.1, pose_, {}});
    pilot_.Tick(now_s_);
  }
  EXPECT_EQ(Reason(), StopReason::kPoseUncertain);
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

TEST_F(PilotTest, PosesThatCannotBeAreNotDrivenBy) {
  const Rigid3 not_finite(Eigen::Quaterniond::Identity(), Eigen::Vector3d(kNaN, 0, 0));
  Rigid3 no_rotation;
  no_rotation.rotation.coeffs().setZero();
  for (const Rigid3& pose : {not_finite, no_rotation}) {
    pilot_ = Pilot(Options());
    pose_ = Rigid3();
    StartDriving();
    pose_ = pose;
    EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
    EXPECT_EQ(Reason(), StopReason::kPoseInvalid);
  }
}

TEST_F(PilotTest, APoseFromTheFutureIsNotDrivenBy) {
  StartDriving();
  has_pose_ = false;
  pilot_.ObservePose(now_s_, {now_s_ + 5, pose_, {}});
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kPoseInvalid);
}

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
  bus_up_ = true;
  EXPECT_TRUE(Run(5).chassis_motion.IsZero());
  pilot_.Start(now_s_);
  EXPECT_GT(Run(2).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, ASilentChassisBlocks) {
  StartDriving();
  for (int i = 0; i < 30; ++i) {
    now_s_ += kTick_s;
    pilot_.ObserveOperator(now_s_);
    pilot_.ObservePose(now_s_, {now_s_, pose_, {}});
    pilot_.ObserveUncertainty(now_s_, {now_s_, 0.01, 0.01});
    pilot_.Tick(now_s_);
  }
  EXPECT_EQ(Reason(), StopReason::kNoFeedback);
}

TEST_F(PilotTest, AChassisThatTellsItsTracksOnlyIsSilent) {
  StartDriving();
  for (int i = 0; i < 27; ++i) {
    now_s_ += kTick_s;
    pilot_.ObserveOperator(now_s_);
    pilot_.ObserveTracks(now_s_, 0, 0);
    pilot_.Tick(now_s_);
    if (i == 23) {
      EXPECT_EQ(State(), DriveState::kDriving) << "0.5 s are allowed";
    }
  }
  EXPECT_EQ(Reason(), StopReason::kNoFeedback);
}

TEST_F(PilotTest, VelocityIsDrivenWhileItIsRenewed) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  pilot_.Start(now_s_);
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(pilot_.SetVelocity(now_s_, {0.05, 0}).is_accepted);
    Run(0.1);
  }
  EXPECT_NEAR(Run(kTick_s).chassis_motion.forward_mps, 0.05, 1e-9);
  EXPECT_TRUE(Run(0.2).chassis_motion.IsZero());
}

TEST_F(PilotTest, AVelocityOfBeforeTheStopIsForgotten) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  pilot_.Start(now_s_);
  pilot_.SetVelocity(now_s_, {0.1, 0});
  ASSERT_FALSE(Run(kTick_s).chassis_motion.IsZero());
  pilot_.Stop();
  pilot_.Start(now_s_);
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
}

TEST_F(PilotTest, AVelocityOfBeforeABlockIsForgotten) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  pilot_.Start(now_s_);
  pilot_.SetVelocity(now_s_, {0.1, 0});
  ASSERT_FALSE(Run(kTick_s).chassis_motion.IsZero());
  pilot_.SetEmergencyStop("test", true);
  Run(kTick_s);
  pilot_.SetEmergencyStop("test", false);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
}

TEST_F(PilotTest, AfterAStopTheSpeedGrowsFromNothing) {
  StartDriving();
  pilot_.CancelRoute();
  Run(kTick_s);
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  const double speed_mps = Run(kTick_s).chassis_motion.forward_mps;
  EXPECT_GT(speed_mps, 0);
  EXPECT_LE(speed_mps, kTick_s * SpeedLimiterOptions().max_acceleration_mps2 + 1e-9);
}

TEST_F(PilotTest, ALateTickIsNoLeapOfTheSpeed) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  pilot_.Start(now_s_);
  Run(kTick_s);
  now_s_ += 0.4;
  pilot_.SetVelocity(now_s_, {0.1, 0});
  const double speed_mps = Run(kTick_s).chassis_motion.forward_mps;
  EXPECT_GT(speed_mps, 0);
  EXPECT_LE(speed_mps, 0.1 * SpeedLimiterOptions().max_acceleration_mps2 + 1e-9) << "0.1 s of it";
}

TEST_F(PilotTest, VelocityNeverExceedsTheCap) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  pilot_.Start(now_s_);
  for (int i = 0; i < 200; ++i) {
    pilot_.SetVelocity(now_s_, {5, 5});
    EXPECT_LE(Run(kTick_s).chassis_motion.forward_mps, 0.1);
  }
}

TEST_F(PilotTest, VelocityIsRefusedWhileThereIsAGoalOrWhereItIsNotFinite) {
  StartDriving();
  EXPECT_FALSE(pilot_.SetVelocity(now_s_, {0, 0.1}).is_accepted);
  pilot_.CancelRoute();
  EXPECT_FALSE(pilot_.SetVelocity(now_s_, {kNaN, 0}).is_accepted);
  EXPECT_TRUE(Run(1).chassis_motion.IsZero());
}

TEST_F(PilotTest, ANewGoalReplacesTheOld) {
  StartDriving();
  pilot_.SetRoute({{-5, 0, {}}});
  EXPECT_EQ(pilot_.TakeResults().at(0).outcome, GoalOutcome::kReplaced);
  EXPECT_EQ(pilot_.Status().num_waypoints, 1u);
  EXPECT_NEAR(pilot_.Status().distance_to_goal_m, 5, 1e-9);
}

TEST_F(PilotTest, AGoalThatComesNoNearerBlocks) {
  PilotOptions options = Options();
  options.max_stall_s = 3;
  pilot_ = Pilot(options);
  StartDriving();
  Run(5);
  EXPECT_EQ(State(), DriveState::kBlocked);
  EXPECT_EQ(Reason(), StopReason::kNoProgress);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  Run(1);
  EXPECT_EQ(State(), DriveState::kDriving) << "a start gives it as long again";
}

TEST_F(PilotTest, AnotherGoalHasTimeOfItsOwnToComeNearer) {
  PilotOptions options = Options();
  options.max_stall_s = 3;
  pilot_ = Pilot(options);
  StartDriving();
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  Run(2);
  EXPECT_EQ(State(), DriveState::kDriving);
}

TEST_F(PilotTest, AStartForgetsAJam) {
  PilotOptions options = Options();
  options.motion.jam_s = 2;
  pilot_ = Pilot(options);
  StartDriving();
  Run(1);
  ASSERT_EQ(Reason(), StopReason::kTrackJammed);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  Run(0.5);
  EXPECT_EQ(State(), DriveState::kDriving);
}

TEST_F(PilotTest, AStandbyBeginsWithTheStop) {
  StartDriving();
  Run(Options().goal_limits.max_standby_s);
  pilot_.Stop();
  Run(0.1);
  EXPECT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
}

TEST_F(PilotTest, AVelocityOfBeforeAGoalIsForgotten) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  pilot_.SetVelocity(now_s_, {0.1, 0});
  ASSERT_FALSE(Run(0.1).chassis_motion.IsZero());
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  pilot_.CancelRoute();
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
}

TEST_F(PilotTest, RunningTracksUnderAStandingRoverBlock) {
  StartDriving();
  for (int i = 0; i < 100 && State() == DriveState::kDriving; ++i) {
    now_s_ += 0.1;
    pilot_.ObserveChassis(now_s_, chassis_);
    pilot_.ObserveTracks(now_s_, 10 * i, 10 * i);
    pilot_.ObserveOperator(now_s_);
    pilot_.ObservePose(now_s_, {now_s_, pose_, {}});
    pilot_.ObserveUncertainty(now_s_, {now_s_, 0.01, 0.01});
    pilot_.Tick(now_s_);
  }
  EXPECT_EQ(Reason(), StopReason::kSlip);
  EXPECT_GT(*pilot_.Status().slip->forward_ratio, 0.9);
  pilot_.ObserveEpoch(2, now_s_);
  EXPECT_FALSE(pilot_.Status().slip);
}

TEST_F(PilotTest, PredictsThePoseBetweenSightsByTheTracks) {
  StartDriving();
  for (int i = 0; i < 10; ++i) {
    now_s_ += kTick_s;
    pilot_.ObserveChassis(now_s_, chassis_);
    pilot_.ObserveTracks(now_s_, 10 * i, 10 * i);
    pilot_.Tick(now_s_);
  }
  EXPECT_NEAR(pilot_.Status().distance_to_goal_m, 5 - 0.09, 1e-6);
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

TEST_F(PilotTest, CommandsOfAnotherDriverBlock) {
  StartDriving();
  pilot_.ObserveForeignCommand(now_s_);
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(Reason(), StopReason::kForeignCommands);
  EXPECT_FALSE(pilot_.Start(now_s_).is_accepted);
  Run(1.1);
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
}

TEST_F(PilotTest, StopLookGoHoldsVelocityCommandsToo) {
  StartStopLookGo();
  double way_m = 0;
  for (int i = 0; i < 500; ++i) {
    pilot_.SetVelocity(now_s_, {0.1, 0});
    now_s_ += kTick_s;
    pilot_.ObserveOperator(now_s_);
    pilot_.ObserveChassis(now_s_, chassis_);
    const int way_mm = static_cast<int>(std::lround(1000 * way_m));
    pilot_.ObserveTracks(now_s_, way_mm, way_mm);
    way_m += kTick_s * pilot_.Tick(now_s_).chassis_motion.forward_mps;
  }
  EXPECT_NEAR(way_m, StopLookGoOptions().step_m, 0.03) << "the eyes have seen nothing since";
}

TEST_F(PilotTest, StopLookGoLooksAfterAStart) {
  StartStopLookGo();
  pilot_.SetVelocity(now_s_, {0.1, 0});
  ASSERT_FALSE(Run(0.1).chassis_motion.IsZero());
  pilot_.Stop();
  Run(kTick_s);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  pilot_.SetVelocity(now_s_, {0.1, 0});
  EXPECT_TRUE(Run(0.1).chassis_motion.IsZero()) << "has not looked";
}

TEST_F(PilotTest, AfterAPauseStopLookGoBeginsAWholeStep) {
  StartStopLookGo();
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  ASSERT_FALSE(Run(0.1).chassis_motion.IsZero());
  const double step_m = StopLookGoOptions().step_m;
  way_mm_ = static_cast<int>(800 * step_m);
  sigma_m_ = 100;
  Run(0.1);
  ASSERT_EQ(State(), DriveState::kPaused);
  sigma_m_ = 0.01;
  pose_.translation.x() = 0.001 * way_mm_;
  ASSERT_FALSE(Run(4).chassis_motion.IsZero());
  way_mm_ += static_cast<int>(800 * step_m);
  EXPECT_GT(Run(0.5).chassis_motion.forward_mps, 0.09);
}

TEST_F(PilotTest, TellsHowFarTheGoalIs) {
  pose_.translation = {1, 1, 0};
  Run(0.1);
  ASSERT_TRUE(pilot_.SetRoute({{1, 1, {}}, {4, 5, 1.}}).is_accepted);
  EXPECT_NEAR(pilot_.Status().heading_error_rad, 1, 1e-9);
  pilot_.CancelRoute();
  const GoalResult result = pilot_.TakeResults().at(0);
  EXPECT_NEAR(result.position_error_m, 5, 1e-9);
  EXPECT_NEAR(result.heading_error_rad, 1, 1e-9);
}

TEST_F(PilotTest, TellsWhatItDrives) {
  StartDriving();
  EXPECT_GT(pilot_.Status().motion.forward_mps, 0.09);
  ASSERT_TRUE(pilot_.SetRoute({{0, 0, {}}, {4, 0, {}}}).is_accepted);
  Run(0.1);
  EXPECT_EQ(pilot_.Status().next_waypoint, 1u);
}

TEST_F(PilotTest, TellsByWhomItWasStoppedUntilItIsStarted) {
  StartDriving();
  pilot_.SetEmergencyStop("test", true);
  Run(0.1);
  EXPECT_EQ(pilot_.TakeResults().back().detail, "by test");
  pilot_.SetEmergencyStop("test", false);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  EXPECT_EQ(pilot_.Status().detail, "");
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

TEST_F(PilotTest, StopLookGoLooksBeforeItTurnsToAnotherGoal) {
  StartStopLookGo();
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  ASSERT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  ASSERT_TRUE(pilot_.SetRoute({{4, 0, {}}}).is_accepted);
  for (int i = 0; i < 25; ++i) EXPECT_LT(Run(kTick_s).chassis_motion.forward_mps, 0.098) << i;
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
}

TEST_F(PilotTest, TiltIsWarnedOfBelowItsLimit) {
  Run(0.2);
  EXPECT_FALSE(pilot_.Status().is_tilt_near_limit);
  pose_ = Rigid3(ExpSO3({22 * M_PI / 180, 0, 0}), Eigen::Vector3d::Zero());
  Run(0.2);
  EXPECT_TRUE(pilot_.Status().is_tilt_near_limit);
}

TEST(PilotOptions, EachPartIsChecked) {
  const auto refuses = [](auto&& spoil) {
    PilotOptions options;
    options.Check();
    spoil(options);
    try {
      options.Check();
      return false;
    } catch (const std::invalid_argument&) {
      return true;
    }
  };
  EXPECT_TRUE(refuses([](auto& options) { options.kinematics.gauge_m = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.limits.max_turn_rate_radps = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.goal.position_tolerance_m = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.stop_look_go.step_m = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.slip.window_m = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.pose.max_tilt_deg = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.chassis.max_feedback_age_s = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.motion.jam_s = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.operator_watch.timeout_s = kNaN; }));
  EXPECT_TRUE(refuses([](auto& options) { options.goal_limits.max_distance_m = kNaN; }));
  for (double PilotOptions::*field :
       {&PilotOptions::settle_s, &PilotOptions::resume_after_s, &PilotOptions::max_pause_s,
        &PilotOptions::fresh_command_s, &PilotOptions::warning_s, &PilotOptions::max_tick_gap_s,
        &PilotOptions::arming_timeout_s, &PilotOptions::max_stall_s,
        &PilotOptions::velocity_timeout_s})
    EXPECT_TRUE(refuses([&](auto& options) { options.*field = kNaN; }));
}

TEST_F(PilotTest, WrongOptionsAreNamed) {
  PilotOptions options;
  options.velocity_timeout_s = 1;
  EXPECT_THROW(Pilot{options}, std::invalid_argument);
  options = PilotOptions();
  options.limits.max_speed_mps = 0.5;
  EXPECT_THROW(Pilot{options}, std::invalid_argument);
  const double infinite = std::numeric_limits<double>::infinity();
  for (double PilotOptions::*field : {&PilotOptions::max_pause_s, &PilotOptions::max_stall_s,
                                      &PilotOptions::warning_s, &PilotOptions::fresh_command_s}) {
    options = PilotOptions();
    options.*field = infinite;
    EXPECT_THROW(Pilot{options}, std::invalid_argument);
  }
  options = PilotOptions();
  options.pose.max_position_sigma_m = infinite;
  EXPECT_THROW(Pilot{options}, std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
