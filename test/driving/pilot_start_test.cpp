#include "pilot_fixture.h"

// What keeps a rover from being started, or from driving off where it was started too soon.

namespace arfm_vo {
namespace {

/// A joystick that is held, or a planner that runs already.
TEST_F(PilotTest, AVelocityThatIsCommandedBeforeTheStartForbidsIt) {
  chassis_.authority = ChassisAuthority::kUs;
  Run(0.1);
  pilot_.SetVelocity(now_s_, {0.1, 0}, "/joystick");
  const Reply reply = pilot_.Start(now_s_);
  EXPECT_FALSE(reply.is_accepted);
  EXPECT_EQ(reply.text, "not started: /joystick commands a velocity already");
  EXPECT_TRUE(Run(0.1).chassis_motion.IsZero());
  pilot_.SetVelocity(now_s_, {0, 0}, "/joystick");
  EXPECT_TRUE(pilot_.Start(now_s_).is_accepted);
}

/// A camera that was switched on just now: what it sees may be told wrong.
TEST_F(PilotTest, BeforeTheExposureHasSettledNothingIsDrivenUnlessOverridden) {
  PilotOptions options = Options();
  for (const bool is_overridden : {false, true}) {
    if (is_overridden) options.overridden_checks = {"exposure"};
    pilot_ = Pilot(options);
    Start();
    pilot_.SetRoute({{5, 0, {}}});
    const double start_s = now_s_;
    while (now_s_ < start_s + 2) {
      pilot_.picture_watch().Observe({now_s_, 20 + 40 * (now_s_ - start_s), 400, 300});
      EXPECT_EQ(Run(0.1).chassis_motion.IsZero(), !is_overridden);
    }
    EXPECT_EQ(Reason(), is_overridden ? StopReason::kNone : StopReason::kExposure);
  }
}

TEST_F(PilotTest, AnExposureThatHasSettledIsDrivenByAfterAWarning) {
  Start();
  pilot_.SetRoute({{5, 0, {}}});
  for (int i = 0; i < 50; ++i) {
    pilot_.picture_watch().Observe({now_s_, 100, 400, 300});
    Run(0.1);
  }
  EXPECT_EQ(State(), DriveState::kDriving);
}

TEST_F(PilotTest, AClockThatIsSetDropsTheGoalAndBlocks) {
  StartDriving();
  pilot_.ObserveClockSet(now_s_, 30);
  EXPECT_TRUE(Run(kTick_s).chassis_motion.IsZero());
  EXPECT_EQ(State(), DriveState::kBlocked);
  EXPECT_EQ(pilot_.Status().detail, "by +30.00 s");
  EXPECT_FALSE(pilot_.Status().has_goal);
}

TEST_F(PilotTest, AnEmergencyStopThatTheStartClearsDoesNotForbidIt) {
  pilot_.SetEmergencyStop("guard", true);
  EXPECT_EQ(pilot_.Check(now_s_, "guard")[0].ToString(),
            "yes emergency_stop: by guard, which a start ends");
  EXPECT_EQ(pilot_.Check(now_s_)[0].ToString(), "no emergency_stop: by guard");
  pilot_.SetEmergencyStop("/button", true);
  EXPECT_EQ(pilot_.Check(now_s_, "guard")[0].is_well, false);
}

TEST_F(PilotTest, TheCheckTellsEachWatch) {
  const auto lines = [this] {
    std::string text;
    for (const CheckLine& line : pilot_.Check(now_s_)) text += line.ToString() + "\n";
    return text;
  };
  EXPECT_NE(lines().find("no chassis: chassis is silent (system state: not heard yet)"),
            std::string::npos);
  Start();
  EXPECT_EQ(lines(),
            "yes emergency_stop: none is set\nyes operator: answers or is not required\n"
            "yes chassis: answers\n"
            "yes clock: goes on evenly\nnot known camera: the odometry tells of no picture\n"
            "not known exposure: the odometry tells of no picture\n"
            "not known both_cameras: the odometry tells of no picture\n");
  Run(2);
  pilot_.ObserveClockSet(now_s_, -30);
  pilot_.SetEmergencyStop("/button", true);
  has_operator_ = false;
  chassis_.is_emergency_stop = true;
  Run(1);
  for (const char* no : {"no emergency_stop: by /button", "no operator", "no chassis: emergency",
                         "no clock: was set just now"})
    EXPECT_NE(lines().find(no), std::string::npos) << no;
  Run(10);
  EXPECT_NE(lines().find("yes clock"), std::string::npos);
}

}  // namespace
}  // namespace arfm_vo
