#include <gtest/gtest.h>
#include <ros/ros.h>
#include <signal.h>

#include <algorithm>
#include <cstdlib>
#include <functional>

#include "nodes/chassis/chassis_world.h"
#include "nodes/node_process.h"

// chassis_node in a world of its own: wall time, but in clock_stall.test, where it is the clock.

namespace arfm_vo {
namespace {

// A loaded machine delays test and node alike; the fault table measures without it.
constexpr double kPatience_s = 0.6;

/// One node and one world for all tests, which run in their order.
class ChassisNodeTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { world_ = new World; }
  static void TearDownTestSuite() { delete world_; }
  void SetUp() override { ASSERT_TRUE(world_->IsConnected()); }
  void TearDown() override {
    std_srvs::Trigger stop;  // there is nobody to take it where the test has ended the node
    ros::service::call("chassis_node/stop", stop);
  }

  static bool Moves() {
    return world_->RunUntil([] { return world_->log_.last.forward_mps > 0.09; });
  }
  static void DriveFarAhead() {
    world_->Drive([] { world_->SendGoal(40, 0); });
  }
  /// Stops within `limit_s` of what is injected, not counting what a machine that is too busy holds
  /// us up for, and says why.
  static void ExpectToStop(const std::function<void()>& inject, double limit_s,
                           const std::string& reason) {
    const double injected_s = World::Now();
    inject();
    EXPECT_LT(SecondsToStop(injected_s), limit_s + kPatience_s);
    EXPECT_TRUE(Says(reason)) << world_->status_.reason;
  }
  /// Waits for the stop and says how long after `since_s` it was on the bus, less what a machine
  /// that is too busy to run this test held it up for; the node it may hold up once more.
  static double SecondsToStop(double since_s) {
    EXPECT_TRUE(world_->RunUntil([] { return world_->log_.last.IsZero(); }));
    return world_->log_.stopped_s - since_s - 2 * world_->held_up_s_;
  }
  /// Waits until the status says why it stopped.
  static bool Says(const std::string& reason) {
    return world_->RunUntil([&] { return world_->status_.reason == reason; });
  }

  static bool Refuses(const std::string& text) {
    return world_->RunUntil([&] {
      return !world_->reports_.empty() && world_->reports_.back().result == GoalReport::REFUSED &&
             world_->reports_.back().text.find(text) != std::string::npos;
    });
  }
  static int NumArrived() {
    return static_cast<int>(
        std::count_if(world_->reports_.begin(), world_->reports_.end(),
                      [](const auto& report) { return report.result == GoalReport::ARRIVED; }));
  }
  static Eigen::Vector3d Place() { return world_->chassis_.plant().WorldFromBase().translation; }

  static World* world_;
};

World* ChassisNodeTest::world_ = nullptr;

TEST_F(ChassisNodeTest, SaysNothingOnTheBusBeforeStart) {
  world_->SendGoal(3, 0, "map");
  world_->Run(1);
  EXPECT_EQ(world_->log_.num_commands, 0);
  EXPECT_EQ(world_->status_.state, DriveStatus::STANDBY);
  world_->Call("cancel");
}

TEST_F(ChassisNodeTest, ASecondNodeOnTheBusIsRefused) {
  std::string can;
  ASSERT_TRUE(ros::param::get("/chassis_node/can", can));
  int status = 0;
  const std::string second = ARFM_VO_PROGRAM_DIR "/chassis_node __name:=second _can:=" + can;
  const std::string said = Finish(popen((second + " 2>&1").c_str(), "r"), status);
  EXPECT_NE(status, 0);
  EXPECT_NE(said.find("another driver has it"), std::string::npos) << said;
  world_->Run(1);  // chassis and operator were silent meanwhile
}

TEST_F(ChassisNodeTest, DrivesByWayOfWaypoints) {
  ASSERT_TRUE(world_->Start());
  const Eigen::Vector2d start = Place().head<2>(), corner(start.x() + 0.3, start.y()),
                        end(start.x() + 0.3, start.y() + 0.35);
  const int num_arrived = NumArrived();
  world_->SendWaypoints({corner, end});
  double nearest_to_corner_m = 1;
  const bool has_arrived = world_->RunUntil([&] {
    nearest_to_corner_m = std::min(nearest_to_corner_m, (Place().head<2>() - corner).norm());
    return NumArrived() > num_arrived;
  });
  ASSERT_TRUE(has_arrived) << world_->status_.reason;
  EXPECT_LT(nearest_to_corner_m, 0.15);  // straight ahead it would be 0.23
  EXPECT_LT((Place().head<2>() - end).norm(), 0.05);
  EXPECT_LE(world_->log_.fastest_mps, 0.1);
  EXPECT_TRUE(world_->log_.last.IsZero());
}

TEST_F(ChassisNodeTest, TheStopServiceStops) {
  DriveFarAhead();
  ExpectToStop([] { world_->Call("stop"); }, 0, "stopped by hand");
}

TEST_F(ChassisNodeTest, TheEmergencyStopTopicStopsAndForbidsStart) {
  DriveFarAhead();
  const double sent_s = World::Now();
  world_->SetEmergencyStop(true);
  EXPECT_LT(SecondsToStop(sent_s), kPatience_s);
  EXPECT_FALSE(world_->Call("start").success);
  const auto check = world_->Call("check");
  EXPECT_NE(check.message.find("\nno emergency_stop: by /"), std::string::npos) << check.message;
  world_->SetEmergencyStop(false);
  EXPECT_TRUE(world_->Start());
  EXPECT_TRUE(Moves());
}

TEST_F(ChassisNodeTest, NobodyElseClearsAnEmergencyStop) {
  DriveFarAhead();
  world_->SetEmergencyStop(true);
  EXPECT_TRUE(Says("software emergency stop is set"));
  ASSERT_EQ(std::system("rostopic pub -1 /emergency_stop std_msgs/Bool 'data: false'"), 0);
  world_->Run(1);
  const auto answer = world_->Call("start");
  EXPECT_FALSE(answer.success);
  EXPECT_NE(answer.message.find(ros::this_node::getName()), std::string::npos) << answer.message;
  EXPECT_TRUE(world_->Call("release_emergency_stop").success);
  world_->SetEmergencyStop(false);  // it is latched: who comes later is told the last
  EXPECT_TRUE(world_->Start());
}

TEST_F(ChassisNodeTest, WithoutTheOperatorTheRoverStopsWithinASecond) {
  DriveFarAhead();
  EXPECT_LT(world_->status_.operator_round_trip_s, 0.5);
  ExpectToStop([] { world_->has_operator_ = false; }, 1.0, "operator does not answer");
  EXPECT_TRUE(world_->RunUntil([] { return std::isnan(world_->status_.operator_round_trip_s); }));
  EXPECT_FALSE(world_->Call("start").success);
  world_->has_operator_ = true;
  EXPECT_TRUE(world_->Start());
}

TEST_F(ChassisNodeTest, AnOdometryThatIsRestartedDropsTheGoalAndBlocks) {
  DriveFarAhead();
  world_->Run(3);
  const Eigen::Vector3d place = Place();
  const int num_arrived = NumArrived();
  world_->RestartOdometry();
  // Its poses come before its status, whose new publisher must first be found.
  EXPECT_TRUE(Says("odometry has started anew"));
  EXPECT_EQ(world_->status_.state, DriveStatus::BLOCKED);
  world_->Run(4);
  EXPECT_LE((Place() - place).norm(), 0.1);
  EXPECT_FALSE(world_->status_.has_goal);
  EXPECT_EQ(NumArrived(), num_arrived);
  world_->SendGoal(1, 0);
  EXPECT_TRUE(Refuses("the rover is blocked"));
  EXPECT_TRUE(world_->Call("start").success);
  world_->Run(1);
  EXPECT_EQ(world_->status_.state, DriveStatus::READY);
}

TEST_F(ChassisNodeTest, StampsOfTheEndOfTimeAreIgnored) {
  DriveFarAhead();
  world_->SendStampsOfTheEnd();
  EXPECT_TRUE(Refuses("its stamp is in the future"));
  world_->Run(2);
  EXPECT_EQ(world_->status_.state, DriveStatus::DRIVING) << world_->status_.reason;
}

TEST_F(ChassisNodeTest, ErrorsAreClearedAtRestOnly) {
  DriveFarAhead();
  EXPECT_EQ(world_->Call("clear_errors").message, "not sent: the rover moves");
  EXPECT_FALSE(world_->Call("set_datum").success);
  world_->Call("stop");
  EXPECT_TRUE(world_->RunUntil([] { return world_->Call("clear_errors").success; }, 5));
  EXPECT_TRUE(world_->Call("set_datum").success);
}

TEST_F(ChassisNodeTest, WithoutAMapOrAPoseItStopsAndHavingItBackResumes) {
  DriveFarAhead();
  ExpectToStop([] { world_->has_map_ = false; }, 1.1, "map frame is no longer told");
  world_->has_map_ = true;
  EXPECT_TRUE(Moves());
  ExpectToStop([] { world_->variance_m2_ = 9999; }, 0, "pose is too uncertain");
  world_->variance_m2_ = 1e-4;
  EXPECT_TRUE(Moves());
  ExpectToStop([] { world_->has_sight_ = false; }, 1.0, "pose is stale");
  world_->Call("stop");
  EXPECT_FALSE(world_->Call("start").success) << "the start-up check misses the camera";
  world_->has_sight_ = true;
}

TEST_F(ChassisNodeTest, TheRemoteControlTakesOverAndTheModeIsAskedForAgain) {
  DriveFarAhead();
  ExpectToStop([] { world_->chassis_.TakeRemoteControl({}); }, 0, "remote control has the rover");
  world_->chassis_.HandBack();
  EXPECT_TRUE(world_->RunUntil([] { return world_->chassis_.mode() == ControlMode::kCan; }));
  EXPECT_TRUE(world_->log_.last.IsZero());
}

TEST_F(ChassisNodeTest, VelocitiesOfTwoNodesBlock) {
  world_->Drive([] { world_->velocity_mps_ = 0.1; });
  FILE* stranger = ::popen(
      "timeout 60 rostopic pub __name:=stranger -r 5 /cmd_vel geometry_msgs/Twist "
      "'{linear: {x: 0.05}}'",
      "r");
  ASSERT_NE(stranger, nullptr);
  EXPECT_TRUE(Says("two nodes command velocities")) << world_->status_.reason;
  EXPECT_NE(world_->status_.detail.find(ros::this_node::getName()), std::string::npos)
      << world_->status_.detail;
  EXPECT_TRUE(world_->RunUntil([] { return world_->log_.last.IsZero(); }));
  world_->velocity_mps_ = 0;
  ASSERT_EQ(::kill(PidOf("/stranger"), SIGINT), 0);
  ::pclose(stranger);
  world_->Run(1);  // chassis and operator were silent meanwhile
}

TEST_F(ChassisNodeTest, EndingTheNodeOrItsTerminalLeavesTheRoverStandingInStandby) {
  for (const int signal : {SIGHUP, SIGTERM}) {
    ASSERT_TRUE(world_->IsConnected());
    DriveFarAhead();
    world_->log_.last_mode = ControlMode::kUnknown;
    const double killed_s = World::Now();
    ASSERT_EQ(::kill(PidOf("/chassis_node"), signal), 0);
    EXPECT_LT(SecondsToStop(killed_s), kPatience_s) << signal;
    EXPECT_TRUE(world_->RunUntil([] { return world_->log_.last_mode == ControlMode::kStandby; }));
    world_->ForgetNode();  // roslaunch starts it anew
  }
}

/// For clock_stall.test, where time is simulated.
using ClockStall = ChassisNodeTest;

TEST_F(ClockStall, AClockThatStandsStillStopsTheRover) {
  DriveFarAhead();
  const double stalled_s = World::Now();
  world_->has_clock_ = false;
  EXPECT_LT(SecondsToStop(stalled_s), 1.1 + kPatience_s);
  world_->has_clock_ = true;
  EXPECT_TRUE(Says("chassis_node was held up"));
  EXPECT_TRUE(world_->log_.last.IsZero());
  EXPECT_TRUE(world_->Start());
  EXPECT_TRUE(Moves());
}

TEST_F(ClockStall, SimulatedTimeThatRunsSlowlyKeepsNoOperator) {
  world_->time_rate_ = 0.2;
  DriveFarAhead();
  ExpectToStop([] { world_->has_operator_ = false; }, 1.0, "operator does not answer");
}

}  // namespace
}  // namespace arfm_vo
