#include <functional>

#include "pilot_fixture.h"

namespace arfm_vo {
namespace {

TEST_F(PilotTest, VelocityIsDrivenWhileItIsRenewed) {
  Start();
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(pilot_.SetVelocity(now_s_, {0.05, 0}).is_accepted);
    Run(0.1);
  }
  EXPECT_NEAR(Run(kTick_s).chassis_motion.forward_mps, 0.05, 1e-9);
  EXPECT_TRUE(Run(0.2).chassis_motion.IsZero());
}

TEST_F(PilotTest, AVelocityOfBeforeAStopABlockOrAGoalIsForgotten) {
  const std::function<void()> kEnds[] = {[this] { pilot_.Stop(); },
                                         [this] {
                                           pilot_.SetEmergencyStop("test", true);
                                           Run(kTick_s);
                                           pilot_.SetEmergencyStop("test", false);
                                         },
                                         [this] {
                                           pilot_.SetRoute({{5, 0, {}}});
                                           pilot_.CancelRoute();
                                         }};
  for (const auto& end : kEnds) {
    Remake();
    Start();
    pilot_.SetVelocity(now_s_, {0.1, 0});
    ASSERT_FALSE(Run(kTick_s).chassis_motion.IsZero());
    end();
    pilot_.Start(now_s_);
    EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
    EXPECT_EQ(State(), DriveState::kReady);
  }
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
  Start();
  Run(kTick_s);
  now_s_ += 0.4;
  pilot_.SetVelocity(now_s_, {0.1, 0});
  const double speed_mps = Run(kTick_s).chassis_motion.forward_mps;
  EXPECT_GT(speed_mps, 0);
  EXPECT_LE(speed_mps, 0.1 * SpeedLimiterOptions().max_acceleration_mps2 + 1e-9) << "0.1 s of it";
}

TEST_F(PilotTest, VelocityNeverExceedsTheCap) {
  Start();
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

TEST_F(PilotTest, VelocitiesOfTwoNodesBlock) {
  Start();
  ASSERT_TRUE(pilot_.SetVelocity(now_s_, {0.1, 0}, "/planner").is_accepted);
  ASSERT_FALSE(Run(0.1).chassis_motion.IsZero());
  EXPECT_FALSE(pilot_.SetVelocity(now_s_, {0, 0}, "/joystick").is_accepted);
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero()) << "whoever of them is right, it stands";
  EXPECT_EQ(Reason(), StopReason::kVelocityConflict);
  EXPECT_EQ(pilot_.Status().detail, "(/planner, /joystick)");
  pilot_.SetVelocity(now_s_, {0.1, 0}, "/planner");
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_FALSE(pilot_.Start(now_s_).is_accepted) << "it commands a motion already";
  Run(0.2);
  ASSERT_TRUE(pilot_.Start(now_s_).is_accepted);
  pilot_.SetVelocity(now_s_, {0.1, 0}, "/planner");
  EXPECT_FALSE(Run(0.1).chassis_motion.IsZero());
}

TEST_F(PilotTest, ANodeTakesOverWhereTheOtherHasEnded) {
  Start();
  pilot_.SetVelocity(now_s_, {0.1, 0}, "/planner");
  Run(Options().velocity_timeout_s + 2 * kTick_s);
  EXPECT_TRUE(pilot_.SetVelocity(now_s_, {0.1, 0}, "/joystick").is_accepted);
  EXPECT_FALSE(Run(0.1).chassis_motion.IsZero());
  pilot_.SetVelocity(now_s_, {0, 0}, "/joystick");
  EXPECT_TRUE(pilot_.SetVelocity(now_s_, {0.1, 0}, "/planner").is_accepted) << "it stands";
}

TEST_F(PilotTest, VelocitiesThatStreamOnThroughAPauseAreWarnedOf) {
  Start();
  const auto run = [&](double duration_s) {
    double fastest_mps = 0;
    for (const double end_s = now_s_ + duration_s; now_s_ < end_s;) {
      pilot_.SetVelocity(now_s_, {0.1, 0}, "/planner");
      fastest_mps = std::max(fastest_mps, Run(kTick_s).chassis_motion.forward_mps);
    }
    return fastest_mps;
  };
  ASSERT_GT(run(1), 0.09) << "just commanded";
  sigma_m_ = 100;
  run(kTick_s);
  sigma_m_ = 0.01;
  EXPECT_EQ(run(Options().resume_after_s + Options().warning_s - 0.2), 0);
  EXPECT_EQ(State(), DriveState::kWarning);
  EXPECT_GT(run(1), 0.05);
}

TEST_F(PilotTest, StopLookGoHoldsVelocityCommandsToo) {
  StartStopLookGo();
  has_pose_ = false;
  double way_m = 0;
  for (int i = 0; i < 500; ++i, way_mm_ = static_cast<int>(std::lround(1000 * way_m))) {
    pilot_.SetVelocity(now_s_, {0.1, 0});
    way_m += kTick_s * Run(kTick_s).chassis_motion.forward_mps;
  }
  EXPECT_NEAR(way_m, StopLookGoOptions().step_m, 0.03) << "the cameras have seen nothing since";
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

TEST_F(PilotTest, StopLookGoLooksBeforeItTurnsToAnotherGoal) {
  StartStopLookGo();
  ASSERT_TRUE(pilot_.SetRoute({{5, 0, {}}}).is_accepted);
  ASSERT_GT(Run(2).chassis_motion.forward_mps, 0.09);
  ASSERT_TRUE(pilot_.SetRoute({{4, 0, {}}}).is_accepted);
  for (int i = 0; i < 25; ++i) EXPECT_LT(Run(kTick_s).chassis_motion.forward_mps, 0.098) << i;
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
}

}  // namespace
}  // namespace arfm_vo
