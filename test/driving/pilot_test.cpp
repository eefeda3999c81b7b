#include <set>

#include "pilot_fixture.h"

namespace arfm_vo {
namespace {

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

TEST_F(PilotTest, ALongStandbyTakesAndKeepsNoGoal) {
  for (const double standby_s : {9.0, 10.1}) {
    const bool is_long = standby_s > 10;
    Remake();
    chassis_.authority = ChassisAuthority::kUs;
    Run(0.1);
    ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
    Run(standby_s);
    EXPECT_EQ(pilot_.TakeResults().size(), is_long) << "cancelled";
    if (is_long) {
      EXPECT_FALSE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
    }
    ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
    EXPECT_EQ(Run(2).chassis_motion.forward_mps > 0.09, !is_long);
  }
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

TEST_F(PilotTest, AGoalWithoutAPoseOrRightAfterANewEpochIsRefused) {
  has_pose_ = false;
  Run(0.1);
  EXPECT_EQ(pilot_.SetRoute({{5, 0, {}}}).text, "goal refused: the rover has no pose");
  has_pose_ = true;
  Run(0.1);
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  pilot_.ObserveEpoch(2, now_s_);
  EXPECT_EQ(pilot_.SetRoute({{5, 0, {}}}).text, "goal refused: the rover has no pose");
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

TEST_F(PilotTest, AnEmergencyStopOfOneTooManySourcesWaitsForAPerson) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  const auto set_all = [&](bool is_set) {
    for (int i = 0; i < 100; ++i) pilot_.SetEmergencyStop(std::to_string(i), is_set);
  };
  set_all(true);
  set_all(false);
  EXPECT_FALSE(pilot_.Start(now_s_).is_accepted);
  pilot_.ReleaseEmergencyStops();
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
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

TEST_F(PilotTest, ANewGoalReplacesTheOld) {
  StartDriving();
  pilot_.SetRoute({{-5, 0, {}}});
  EXPECT_EQ(pilot_.TakeResults().at(0).outcome, GoalOutcome::kReplaced);
  EXPECT_EQ(pilot_.Status().num_waypoints, 1u);
  EXPECT_NEAR(pilot_.Status().distance_to_goal_m, 5, 1e-9);
}

TEST_F(PilotTest, AGoalThatComesNoNearerBlocksAndEachHasTimeOfItsOwn) {
  Remake([](PilotOptions& options) { options.max_stall_s = 3; });
  StartDriving();
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  Run(2);
  EXPECT_EQ(State(), DriveState::kDriving) << "4 s in all";
  Run(3);
  EXPECT_EQ(State(), DriveState::kBlocked);
  EXPECT_EQ(Reason(), StopReason::kNoProgress);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  Run(1);
  EXPECT_EQ(State(), DriveState::kDriving) << "a start gives it as long again";
}

TEST_F(PilotTest, AStandbyBeginsWithTheStop) {
  StartDriving();
  Run(Options().goal_limits.max_standby_s);
  pilot_.Stop();
  Run(0.1);
  EXPECT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
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

TEST(DrivingNames, EachValueHasANameOfItsOwn) {
  const auto expect_distinct = [](auto last) {
    using Value = decltype(last);
    std::set<std::string> names;
    const int num_values = static_cast<int>(last) + 1;
    for (int i = 0; i < num_values; ++i) names.insert(ToString(static_cast<Value>(i)));
    EXPECT_EQ(static_cast<int>(names.size()), num_values);
    EXPECT_EQ(names.count("unknown"), 0u);
    EXPECT_EQ(names.count(""), 0u);
  };
  expect_distinct(DriveState::kWarning);
  expect_distinct(StopReason::kVelocityConflict);
  expect_distinct(GoalOutcome::kReplaced);
  expect_distinct(DrivePhase::kArrived);
}

}  // namespace
}  // namespace arfm_vo
