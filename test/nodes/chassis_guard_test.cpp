#include <arfm_vo/DriveStatus.h>
#include <arpa/inet.h>
#include <geometry_msgs/Twist.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <signal.h>
#include <std_srvs/Trigger.h>

#include <algorithm>

#include "arfm_vo/base/format.h"
#include "arfm_vo/driving/start_check.h"
#include "arfm_vo/hardware/file_descriptor.h"
#include "arfm_vo/simulation/simulated_chassis.h"
#include "hardware/guard/started_process.h"
#include "nodes/node_process.h"
#include "simulation/tapped_bus.h"

// chassis_node behind chassis_guard, both as processes, and a chassis on the bus whose time-out of
// 0.5 s is longer than what is allowed here. Wall time.

namespace arfm_vo {
namespace {

constexpr double kMaxStop_s = 0.2, kMaxWay_m = 0.05;

class GuardedNodeTest : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(ros::param::get("~digits", digits_));
    StartGuard();
    StartNode();
  }
  void StartGuard() {
    guard_.reset();
    guard_ = std::make_unique<StartedProcess>(std::vector<std::string>{
        "chassis_guard", "udp:3" + digits_ + ":4" + digits_, "--stop-port", "5" + digits_});
  }
  void StartNode() {
    node_.reset();
    // All but the emergency stop: that of the guard must not keep a start from releasing it.
    ros::param::set("/guarded/chassis_node/pilot/overridden_checks",
                    std::vector<std::string>(std::begin(kCheckItems) + 1, std::end(kCheckItems)));
    node_ = std::make_unique<StartedProcess>(std::vector<std::string>{
        "chassis_node", "__ns:=guarded", "_can:=guard:udp:3" + digits_ + ":4" + digits_,
        "_pilot/velocity_needs_pose:=false", "_pilot/operator_watch/is_required:=false"});
  }
  static double Now() { return ros::SteadyTime::now().toSec(); }

  template <class Done>
  bool RunUntil(Done&& done, double limit_s = 30) {
    const double end_s = Now() + limit_s;
    bool is_done = false;
    for (double looked_s = Now(); !is_done && Now() < end_s; is_done = done()) {
      held_up_s_ = std::max(held_up_s_, Now() - looked_s);
      looked_s = Now();
      chassis_.Tick(Now());
      if (Now() >= velocity_due_s_) {
        geometry_msgs::Twist ahead;
        ahead.linear.x = 0.1;
        velocity_.publish(ahead);
        velocity_due_s_ = Now() + 0.04;
      }
      ros::spinOnce();
      ros::WallDuration(0.001).sleep();
    }
    return is_done;
  }
  bool Moves() {
    return RunUntil([this] { return log_.last.forward_mps > 0.09 && Speed() > 0.09; }, 6);
  }
  double Speed() const { return chassis_.plant().Speeds().left_mps; }
  /// A person starts it until it drives.
  void Drive() {
    bool moves = false;
    for (int i = 0; i < 10 && !moves; ++i) {
      std_srvs::Trigger start;
      velocity_due_s_ = Now() + 60;  // a start is refused while a velocity is commanded
      RunUntil([&] {
        return ros::service::call("/guarded/chassis_node/start", start) && start.response.success;
      });
      velocity_due_s_ = 0;
      moves = Moves();
    }
    ASSERT_TRUE(moves) << status_.state_text << ": " << status_.reason << " " << status_.detail;
    held_up_s_ = 0;
  }
  /// From now to the zero on the bus and to the tracks' rest; what the machine held this test up
  /// for does not count.
  void ExpectToStop(const std::string& what) {
    const double began_s = Now(), way_m = chassis_.plant().DrivenDistance();
    EXPECT_TRUE(RunUntil([&] { return log_.last.IsZero() && Speed() < 1e-3; })) << what;
    const double stop_s = log_.stopped_s - began_s, held_up_s = held_up_s_;
    const double gone_m = chassis_.plant().DrivenDistance() - way_m;
    std::printf("%s: zero after %.0f ms, %.3f m\n", what.c_str(), 1000 * stop_s, gone_m);
    EXPECT_LT(stop_s, kMaxStop_s + held_up_s) << what;
    EXPECT_LT(gone_m, kMaxWay_m + 0.1 * held_up_s) << what;
  }
  void ExpectToSay(const std::string& reason, const std::string& detail) {
    EXPECT_TRUE(RunUntil([&] {
      return status_.reason == reason && status_.detail.find(detail) != std::string::npos;
    })) << status_.reason
        << " " << status_.detail;
  }

  ros::NodeHandle names_{"guarded"};
  std::string digits_ = ros::param::param<std::string>("~digits", "");
  TappedBus::Log log_;
  SimulatedChassis chassis_{
      std::make_unique<TappedBus>(OpenCanBus("udp:4" + digits_ + ":3" + digits_), &log_),
      TrackedPlant(TrackedPlantOptions{}, RoverPose{})};
  ros::Publisher velocity_ = names_.advertise<geometry_msgs::Twist>("cmd_vel", 1);
  DriveStatus status_;
  ros::Subscriber status_subscriber_ = names_.subscribe<DriveStatus>(
      "drive_status", 10, [this](const DriveStatus::ConstPtr& status) { status_ = *status; });
  double velocity_due_s_ = 0, held_up_s_ = 0;
  std::unique_ptr<StartedProcess> guard_, node_;
};

TEST_F(GuardedNodeTest, ANodeThatIsKilledOrHangsIsStoppedByTheGuard) {
  Drive();
  node_->Signal(SIGKILL);
  ExpectToStop("chassis_node killed");
  StartNode();
  Drive();
  node_->Signal(SIGSTOP);
  ExpectToStop("chassis_node hangs");
  node_->Signal(SIGCONT);
  ExpectToSay("chassis_node was held up", "");
  Drive();
}

TEST_F(GuardedNodeTest, AGuardThatIsKilledOrHangsIsABusThatIsDownAndTheNodeSendsZero) {
  Drive();
  guard_->Signal(SIGKILL);
  ExpectToStop("chassis_guard killed");
  ExpectToSay("CAN bus is down", "chassis_guard does not answer");
  const int num_commands = log_.num_commands;
  RunUntil([] { return false; }, 0.5);
  EXPECT_GT(log_.num_commands, num_commands + 10);
  EXPECT_TRUE(log_.last.IsZero());
  StartGuard();
  Drive();
  guard_->Signal(SIGSTOP);
  ExpectToStop("chassis_guard hangs");
  ExpectToSay("CAN bus is down", "chassis_guard does not answer");
  RunUntil([] { return false; }, 1.5);
  guard_->Signal(SIGCONT);
  log_.fastest_mps = 0;
  RunUntil([] { return false; }, 1);
  EXPECT_EQ(log_.fastest_mps, 0) << "it wakes up with old commands";
  Drive();
}

TEST_F(GuardedNodeTest, APacketStopsUntilTheOperatorStartsAnew) {
  Drive();
  FileDescriptor person(::socket(AF_INET, SOCK_DGRAM, 0));
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(std::stoi("5" + digits_)));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  ::sendto(person.Get(), "stop", 4, 0, reinterpret_cast<sockaddr*>(&address), sizeof(address));
  ExpectToStop("a packet");
  ExpectToSay("software emergency stop is set", "by chassis_guard");
  log_.fastest_mps = 0;
  RunUntil([] { return false; }, 1);
  EXPECT_EQ(log_.fastest_mps, 0);
  Drive();
}

TEST_F(GuardedNodeTest, TheOperatorsScriptSendsThePacket) {
  Drive();
  // Its terminal is gone, which is as good as Enter.
  FILE* relay = ::popen(Format("%s --relay --stop-port 5%s 2>&1 < /dev/null",
                               ARFM_VO_SOURCE_DIR "/scripts/operator_answer.py", digits_.c_str())
                            .c_str(),
                        "r");
  ASSERT_NE(relay, nullptr);
  EXPECT_TRUE(RunUntil([this] { return log_.last.IsZero(); }));
  ExpectToSay("software emergency stop is set", "by chassis_guard");
  int status = 0;
  const std::string said = Finish(relay, status);
  EXPECT_NE(said.find("stop: stopped by chassis_guard"), std::string::npos) << said;
}

TEST_F(GuardedNodeTest, ARoverThatRunsAwayIsBrakedAndDrivesOnAfterAStart) {
  Drive();
  chassis_.SetRunaway(PlanarMotion{0.3, 0});
  EXPECT_TRUE(RunUntil([this] { return chassis_.is_brake_on(); }));
  ExpectToSay("tracks run faster than commanded", "");
  chassis_.SetRunaway({});
  RunUntil([this] { return Speed() < 1e-3; });
  Drive();
  EXPECT_FALSE(chassis_.is_brake_on());
}

}  // namespace
}  // namespace arfm_vo
