#include <gtest/gtest.h>
#include <signal.h>

#include "arfm_vo/base/format.h"
#include "arfm_vo/driving/start_check.h"
#include "hardware/guard/loopback_socket.h"
#include "hardware/guard/started_process.h"
#include "nodes/chassis/chassis_world.h"
#include "nodes/node_process.h"

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
    world_.ForgetNode();
    // All but the emergency stop: that of the guard must not keep a start from releasing it.
    ros::param::set("/guarded/chassis_node/pilot/overridden_checks",
                    std::vector<std::string>(std::begin(kCheckItems) + 1, std::end(kCheckItems)));
    node_ = std::make_unique<StartedProcess>(std::vector<std::string>{
        "chassis_node", "__ns:=guarded", "_can:=guard:udp:3" + digits_ + ":4" + digits_,
        "_pilot/velocity_needs_pose:=false", "_pilot/operator_watch/is_required:=false"});
  }
  bool RunUntil(const std::function<bool()>& done) { return world_.RunUntil(done, 30); }
  double Speed() const { return world_.chassis_.plant().Speeds().left_mps; }
  /// A person starts it until it drives.
  void Drive() {
    ASSERT_TRUE(world_.IsConnected());
    world_.Drive([this] { world_.velocity_mps_ = 0.1; });
    ASSERT_TRUE(RunUntil([this] { return Speed() > 0.09; }));
    world_.held_up_s_ = 0;
  }
  /// From now to the zero on the bus and to the tracks' rest; what the machine held this test up
  /// for does not count.
  void ExpectToStop(const std::string& what) {
    const double began_s = World::Now(), way_m = world_.chassis_.plant().DrivenDistance();
    EXPECT_TRUE(RunUntil([&] { return world_.log_.last.IsZero() && Speed() < 1e-3; })) << what;
    const double stop_s = world_.log_.stopped_s - began_s, held_up_s = world_.held_up_s_;
    const double gone_m = world_.chassis_.plant().DrivenDistance() - way_m;
    std::printf("%s: zero after %.0f ms, %.3f m\n", what.c_str(), 1000 * stop_s, gone_m);
    EXPECT_LT(stop_s, kMaxStop_s + held_up_s) << what;
    EXPECT_LT(gone_m, kMaxWay_m + 0.1 * held_up_s) << what;
  }
  /// From now on, for a second, although velocities are commanded.
  void ExpectToStand(const std::string& why) {
    world_.log_.fastest_mps = 0;
    world_.Run(1);
    EXPECT_EQ(world_.log_.fastest_mps, 0) << why;
  }
  void ExpectToSay(const std::string& reason, const std::string& detail) {
    const DriveStatus& status = world_.status_;
    EXPECT_TRUE(RunUntil([&] {
      return status.reason == reason && status.detail.find(detail) != std::string::npos;
    })) << status.reason
        << " " << status.detail;
  }

  std::string digits_ = ros::param::param<std::string>("~digits", "");
  World world_{"guarded", "udp:4" + digits_ + ":3" + digits_};
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

TEST_F(GuardedNodeTest, ANodeThatIsHeldUpForAMomentGoesOnWithAWarning) {
  Drive();
  node_->Signal(SIGSTOP);
  EXPECT_TRUE(RunUntil([this] { return world_.log_.last.IsZero(); }));
  world_.log_.fastest_mps = 0;
  node_->Signal(SIGCONT);
  ExpectToSay("chassis_node was held up", "");
  const auto& state = world_.status_.state;
  // After more than 0.5 s on a busy machine it needs a start.
  EXPECT_TRUE(
      RunUntil([&] { return state == DriveStatus::WARNING || state == DriveStatus::BLOCKED; }));
  const bool is_going_on = state == DriveStatus::WARNING;
  EXPECT_EQ(world_.log_.fastest_mps, 0) << "before the warning";
  if (is_going_on) EXPECT_TRUE(RunUntil([this] { return Speed() > 0.09; }));
}

TEST_F(GuardedNodeTest, AGuardThatIsKilledOrHangsIsABusThatIsDownAndTheNodeSendsZero) {
  Drive();
  guard_->Signal(SIGKILL);
  ExpectToStop("chassis_guard killed");
  ExpectToSay("CAN bus is down", "chassis_guard does not answer");
  const int num_commands = world_.log_.num_commands;
  world_.Run(0.5);
  EXPECT_GT(world_.log_.num_commands, num_commands + 10);
  EXPECT_TRUE(world_.log_.last.IsZero());
  StartGuard();
  Drive();
  guard_->Signal(SIGSTOP);
  ExpectToStop("chassis_guard hangs");
  ExpectToSay("CAN bus is down", "chassis_guard does not answer");
  world_.Run(1.5);
  guard_->Signal(SIGCONT);
  ExpectToStand("it wakes up with old commands");
  Drive();
}

TEST_F(GuardedNodeTest, APacketStopsUntilTheOperatorStartsAnew) {
  Drive();
  const LoopbackSocket person;
  ASSERT_TRUE(person.SendTo(static_cast<uint16_t>(std::stoi("5" + digits_)), "stop"));
  ExpectToStop("a packet");
  ExpectToSay("software emergency stop is set", "by chassis_guard");
  ExpectToStand("until a start");
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
  EXPECT_TRUE(RunUntil([this] { return world_.log_.last.IsZero(); }));
  ExpectToSay("software emergency stop is set", "by chassis_guard");
  int status = 0;
  const std::string said = Finish(relay, status);
  EXPECT_NE(said.find("stop: stopped by chassis_guard"), std::string::npos) << said;
}

TEST_F(GuardedNodeTest, ARoverThatRunsAwayIsBrakedAndDrivesOnAfterAStart) {
  Drive();
  world_.chassis_.SetRunaway(PlanarMotion{0.3, 0});
  EXPECT_TRUE(RunUntil([this] { return world_.chassis_.is_brake_on(); }));
  ExpectToSay("tracks run faster than commanded", "");
  world_.chassis_.SetRunaway({});
  RunUntil([this] { return Speed() < 1e-3; });
  Drive();
  EXPECT_FALSE(world_.chassis_.is_brake_on());
}

}  // namespace
}  // namespace arfm_vo
