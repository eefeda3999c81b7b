#include <arfm_vo/DriveStatus.h>
#include <arfm_vo/GoalReport.h>
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <signal.h>
#include <std_msgs/Bool.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include "arfm_vo/ros/conversions.h"
#include "arfm_vo/simulation/simulated_chassis.h"
#include "nodes/node_process.h"

// chassis_node in a world of its own: a simulated chassis at the other end of the bus, and a
// perfect sight in tf. Wall time.

namespace arfm_vo {
namespace {

/// Notes the commands that pass on their way to the simulated chassis.
class TappedBus : public CanBus {
 public:
  struct Log {
    int num_commands = 0;
    PlanarMotion last;
    double stopped_s = 0, fastest_mps = 0;
    ControlMode last_mode = ControlMode::kUnknown;
  };

  TappedBus(std::unique_ptr<CanBus> bus, Log* log) : bus_(std::move(bus)), log_(log) {}
  CanSendStatus Send(const CanFrame& frame) override { return bus_->Send(frame); }
  CanBusState State() const override { return bus_->State(); }
  std::optional<CanFrame> Receive() override {
    const auto frame = bus_->Receive();
    if (frame) Note(DecodeCommand(*frame));
    return frame;
  }

 private:
  void Note(const ChassisCommand& command) {
    log_->num_commands += command.index() != 0;
    if (const auto* mode = std::get_if<ControlModeCommand>(&command)) log_->last_mode = mode->mode;
    const auto* motion = std::get_if<MotionCommand>(&command);
    if (!motion) return;
    if (motion->motion.IsZero() && !log_->last.IsZero())
      log_->stopped_s = ros::SteadyTime::now().toSec();
    log_->last = motion->motion;
    log_->fastest_mps = std::max(log_->fastest_mps, std::abs(motion->motion.forward_mps));
  }

  std::unique_ptr<CanBus> bus_;
  Log* log_;
};

class World {
 public:
  World()
      : chassis_(OpenChassisBus(), TrackedPlant(TrackedPlantOptions{}, RoverPose{})),
        goal_(node_.advertise<geometry_msgs::PoseStamped>("goal", 1)),
        emergency_stop_(node_.advertise<std_msgs::Bool>("emergency_stop", 1, true)),
        odom_(node_.advertise<nav_msgs::Odometry>("odom", 1)),
        status_subscriber_(node_.subscribe("drive_status", 20, &World::TakeStatus, this)),
        report_subscriber_(node_.subscribe("goal_report", 20, &World::TakeReport, this)) {
    geometry_msgs::TransformStamped map_from_odom = Transform("map", "odom", Rigid3());
    static_broadcaster_.sendTransform(map_from_odom);
  }

  /// Goes on until done(), at most for a minute; says whether it was done.
  template <class Done>
  bool RunUntil(Done&& done, double limit_s = 60) {
    const double end_s = Now() + limit_s;
    while (ros::ok() && Now() < end_s && !done()) {
      chassis_.Tick(Now());
      if (Now() >= sight_due_s_) See();
      ros::spinOnce();
      ros::WallDuration(0.002).sleep();
    }
    return done();
  }
  void Run(double duration_s) {
    RunUntil([] { return false; }, duration_s);
  }

  std_srvs::Trigger::Response Call(const std::string& service) {
    std_srvs::Trigger trigger;
    EXPECT_TRUE(ros::service::call("chassis_node/" + service, trigger)) << service;
    return trigger.response;
  }
  void SendGoal(double x_m, double y_m, const std::string& frame = "base_link") {
    geometry_msgs::PoseStamped goal;
    goal.header.frame_id = frame;
    goal.pose.position.x = x_m;
    goal.pose.position.y = y_m;
    goal.pose.orientation.w = 1;
    goal_.publish(goal);
  }
  void SetEmergencyStop(bool is_set) {
    std_msgs::Bool message;
    message.data = is_set;
    emergency_stop_.publish(message);
  }
  /// Waits until every topic has its other end.
  bool IsConnected() {
    return RunUntil([this] {
      return goal_.getNumSubscribers() > 0 && odom_.getNumSubscribers() > 0 &&
             emergency_stop_.getNumSubscribers() > 0 && has_status_;
    });
  }
  static double Now() { return ros::SteadyTime::now().toSec(); }

  TappedBus::Log log_;
  SimulatedChassis chassis_;
  DriveStatus status_;
  std::vector<GoalReport> reports_;
  bool has_sight_ = true;
  double variance_m2_ = 1e-4;

 private:
  std::unique_ptr<CanBus> OpenChassisBus() {
    std::string address;
    if (!ros::param::get("~can", address)) throw std::runtime_error("no parameter ~can");
    return std::make_unique<TappedBus>(OpenCanBus(address), &log_);
  }
  static geometry_msgs::TransformStamped Transform(const std::string& parent,
                                                   const std::string& child, const Rigid3& pose) {
    geometry_msgs::TransformStamped transform;
    transform.header.stamp = ros::Time::now();
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    transform.transform = ToTransformMessage(pose);
    return transform;
  }
  void See() {
    sight_due_s_ = Now() + 0.05;
    if (!has_sight_) return;
    const Rigid3 pose = chassis_.plant().WorldFromBase();
    broadcaster_.sendTransform(Transform("odom", "base_link", pose));
    nav_msgs::Odometry odometry;
    odometry.header.stamp = ros::Time::now();
    odometry.header.frame_id = "odom";
    odometry.pose.pose = ToPoseMessage(pose);
    for (int i = 0; i < 6; ++i) odometry.pose.covariance[7 * i] = variance_m2_;
    odom_.publish(odometry);
  }
  void TakeStatus(const DriveStatus& status) {
    status_ = status;
    has_status_ = true;
  }
  void TakeReport(const GoalReport& report) { reports_.push_back(report); }

  ros::NodeHandle node_;
  ros::Publisher goal_, emergency_stop_, odom_;
  ros::Subscriber status_subscriber_, report_subscriber_;
  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
  bool has_status_ = false;
  double sight_due_s_ = 0;
};

/// One node and one world for all tests, which run in their order.
class ChassisNodeTest : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { world_ = new World; }
  static void TearDownTestSuite() { delete world_; }
  void SetUp() override { ASSERT_TRUE(world_->IsConnected()); }

  static bool Moves() {
    return world_->RunUntil([] { return world_->log_.last.forward_mps > 0.09; });
  }
  static void DriveFarAhead() {
    ASSERT_TRUE(world_->Call("start").success);
    world_->SendGoal(50, 0);
    ASSERT_TRUE(Moves()) << world_->status_.state_text << ": " << world_->status_.reason;
  }
  /// Waits for the stop and says how long after `since_s` it was on the bus.
  static double SecondsToStop(double since_s) {
    EXPECT_TRUE(world_->RunUntil([] { return world_->log_.last.IsZero(); }));
    return world_->log_.stopped_s - since_s;
  }
  /// Waits until the status says why it stopped.
  static bool Says(const std::string& reason) {
    return world_->RunUntil([&] { return world_->status_.reason == reason; });
  }

  static World* world_;
};

World* ChassisNodeTest::world_ = nullptr;

// A loaded machine delays test and node alike; the fault table measures without it.
constexpr double kPatience_s = 0.6;

TEST_F(ChassisNodeTest, SaysNothingOnTheBusBeforeStart) {
  world_->SendGoal(3, 0, "map");
  world_->Run(1);
  EXPECT_EQ(world_->log_.num_commands, 0);
  EXPECT_EQ(world_->status_.state, DriveStatus::STANDBY);
  world_->Call("cancel");
}

TEST_F(ChassisNodeTest, RefusesGoalsThatAreNone) {
  const auto refused = [](const std::string& text) {
    return world_->RunUntil([&] {
      return !world_->reports_.empty() && world_->reports_.back().result == GoalReport::REFUSED &&
             world_->reports_.back().text.find(text) != std::string::npos;
    });
  };
  world_->SendGoal(std::numeric_limits<double>::quiet_NaN(), 0);
  EXPECT_TRUE(refused("its position is not finite"));
  world_->SendGoal(1, 0, "moon");
  EXPECT_TRUE(refused("frame 'moon'"));
}

TEST_F(ChassisNodeTest, DrivesToAGoalBeforeTheRoverAndReportsIt) {
  ASSERT_TRUE(world_->Call("start").success);
  world_->SendGoal(0.4, 0);
  const auto has_arrived = [] {
    return !world_->reports_.empty() && world_->reports_.back().result == GoalReport::ARRIVED;
  };
  ASSERT_TRUE(world_->RunUntil(has_arrived)) << world_->status_.reason;
  EXPECT_NEAR(world_->chassis_.plant().Pose().x_m, 0.4, 0.05);
  EXPECT_LE(world_->log_.fastest_mps, 0.1);
  EXPECT_TRUE(world_->log_.last.IsZero());
}

TEST_F(ChassisNodeTest, TheStopServiceStops) {
  DriveFarAhead();
  const double called_s = World::Now();
  world_->Call("stop");
  EXPECT_LT(SecondsToStop(called_s), kPatience_s);
  EXPECT_TRUE(Says("stopped by hand"));
}

TEST_F(ChassisNodeTest, TheEmergencyStopTopicStopsAndForbidsStart) {
  DriveFarAhead();
  const double sent_s = World::Now();
  world_->SetEmergencyStop(true);
  EXPECT_LT(SecondsToStop(sent_s), kPatience_s);
  EXPECT_FALSE(world_->Call("start").success);
  world_->SetEmergencyStop(false);
  EXPECT_TRUE(world_->RunUntil([] { return world_->Call("start").success; }));
  EXPECT_TRUE(Moves());
  world_->Call("stop");
}

TEST_F(ChassisNodeTest, LosingTheOdometryStopsAndHavingItBackResumes) {
  DriveFarAhead();
  const double lost_s = World::Now();
  world_->variance_m2_ = 9999;
  EXPECT_LT(SecondsToStop(lost_s), kPatience_s);
  EXPECT_TRUE(Says("pose is too uncertain"));
  world_->variance_m2_ = 1e-4;
  EXPECT_TRUE(Moves());
  world_->Call("stop");
}

TEST_F(ChassisNodeTest, AStalePoseStops) {
  DriveFarAhead();
  const double silent_s = World::Now();
  world_->has_sight_ = false;
  EXPECT_LT(SecondsToStop(silent_s), 1.0 + kPatience_s);
  EXPECT_TRUE(Says("pose is stale"));
  world_->has_sight_ = true;
  world_->Call("stop");
}

TEST_F(ChassisNodeTest, TheRemoteControlTakesOverAndTheModeIsAskedForAgain) {
  DriveFarAhead();
  const double taken_s = World::Now();
  world_->chassis_.TakeRemoteControl({});
  EXPECT_LT(SecondsToStop(taken_s), kPatience_s);
  EXPECT_TRUE(Says("remote control has the rover"));
  world_->chassis_.HandBack();
  EXPECT_TRUE(world_->RunUntil([] { return world_->chassis_.mode() == ControlMode::kCan; }));
  EXPECT_TRUE(world_->log_.last.IsZero());
  world_->Call("stop");
}

TEST_F(ChassisNodeTest, EndingTheNodeLeavesTheRoverStandingInStandby) {
  DriveFarAhead();
  const double killed_s = World::Now();
  ASSERT_EQ(::kill(PidOf("/chassis_node"), SIGTERM), 0);
  EXPECT_LT(SecondsToStop(killed_s), kPatience_s);
  EXPECT_TRUE(world_->RunUntil([] { return world_->log_.last_mode == ControlMode::kStandby; }));
}

}  // namespace
}  // namespace arfm_vo

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "test_chassis_node");
  ros::NodeHandle keep_alive;
  return RUN_ALL_TESTS();
}
