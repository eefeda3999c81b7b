#include "arfm_vo/hardware/guard/guarded_bus.h"

#include <gtest/gtest.h>
#include <net/if.h>

#include <cstdlib>

#include "arfm_vo/hardware/chassis_protocol.h"
#include "arfm_vo/hardware/clock_offset.h"
#include "hardware/guard/loopback_socket.h"
#include "hardware/guard/started_process.h"

namespace arfm_vo {
namespace {

const CanFrame kCommand = EncodeFrame(MotionCommand{{0.1, 0}});

TEST(GuardMessage, WhatIsNoneIsRefused) {
  GuardMessage message;
  message.frame = kCommand;
  const auto reads = [&](size_t size = sizeof(GuardMessage)) {
    return ReadGuardMessage(&message, size).has_value();
  };
  EXPECT_TRUE(reads());
  EXPECT_FALSE(reads(sizeof(message) - 1));
  message.version = 1;
  EXPECT_FALSE(reads());
  message.version = 2;
  message.frame.dlc = 9;
  EXPECT_FALSE(reads());
  message.frame.dlc = 8;
  message.stop = GuardStop::kForeign;
  EXPECT_FALSE(reads());
}

/// chassis_guard as a process; chassis_node's end and the chassis here. Over UDP, and over the
/// kernel's CAN where there is vcan0, as in the virtual machine of scripts/test_hardware.sh.
class GuardedBusTest : public ::testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const bool is_can = GetParam() == "vcan";
    if (is_can && (::if_nametoindex("vcan0") == 0 || std::system("ip link set vcan0 up") != 0))
      GTEST_SKIP() << "there is no interface vcan0";
    bus_address_ = is_can ? "vcan0" : UdpAddress(port_, chassis_port_);
    chassis_ = OpenCanBus(is_can ? "vcan0" : UdpAddress(chassis_port_, port_));
    bus_ = OpenCanBus("guard:" + bus_address_);
  }
  void StartGuard() {
    guard_ = std::make_unique<StartedProcess>(std::vector<std::string>{
        "chassis_guard", bus_address_, "--stop-port", std::to_string(stop_port_)});
  }
  /// Until done(); at most 10 s.
  template <class Done>
  bool RunUntil(Done&& done) {
    const double end_s = MonotonicNow() + 10;
    while (!done() && MonotonicNow() < end_s) {
      ::usleep(1000);
      while (const auto frame = bus_->Receive()) told_ = *frame;
      while (const auto frame = chassis_->Receive()) sent_.push_back(ToString(*frame));
    }
    return done();
  }
  bool IsUp() {
    return RunUntil([this] { return bus_->State() == CanBusState::kUp; });
  }
  bool Sends(const CanFrame& frame, const std::string& on_bus) {
    sent_.clear();
    return RunUntil([&] { return bus_->Send(frame), !sent_.empty() && sent_.back() == on_bus; });
  }

  const uint16_t port_ = FreePort(), chassis_port_ = FreePort(), stop_port_ = FreePort();
  std::string bus_address_;
  std::unique_ptr<CanBus> chassis_, bus_;
  std::unique_ptr<StartedProcess> guard_;
  std::vector<std::string> sent_;  // to the chassis
  CanFrame told_;
};

TEST_P(GuardedBusTest, CarriesFramesBothWaysOnceTheGuardIsThere) {
  EXPECT_EQ(bus_->State(), CanBusState::kNoGuard);
  EXPECT_EQ(bus_->Send(kCommand), CanSendStatus::kDown);
  EXPECT_FALSE(chassis_->Receive()) << "nothing was sent before: nothing is to be stopped";
  StartGuard();
  ASSERT_TRUE(IsUp());
  EXPECT_TRUE(Sends(kCommand, "111#0064000000000000"));
  const CanFrame state = EncodeFrame(MotionState{{0.1, 0}});
  chassis_->Send(state);
  EXPECT_TRUE(RunUntil([&] { return told_ == state; }));
  EXPECT_EQ(bus_->StandingStop(), GuardStop::kNone);
}

TEST_P(GuardedBusTest, AGuardThatEndsOrHangsIsABusThatIsDownAndOnlyZeroGoesOut) {
  for (const int signal : {SIGKILL, SIGSTOP}) {
    StartGuard();
    ASSERT_TRUE(IsUp());
    ASSERT_TRUE(Sends(kCommand, "111#0064000000000000"));
    guard_->Signal(signal);
    ASSERT_TRUE(RunUntil([&] { return bus_->State() == CanBusState::kNoGuard; })) << signal;
    EXPECT_EQ(bus_->Send(kCommand), CanSendStatus::kDown);
    EXPECT_TRUE(Sends(kCommand, "111#0000000000000000")) << signal;
    EXPECT_TRUE(Sends(EncodeFrame(ClearErrorsCommand{}), "111#0000000000000000")) << signal;
    EXPECT_TRUE(Sends(EncodeFrame(ControlModeCommand{}), "421#00")) << signal;
    guard_.reset();
  }
}

TEST_P(GuardedBusTest, WhatAGuardFindsOldWhenItWakesIsNotSent) {
  StartGuard();
  ASSERT_TRUE(IsUp());
  ASSERT_TRUE(Sends(kCommand, "111#0064000000000000"));
  guard_->Signal(SIGSTOP);
  for (int i = 0; i < 50; ++i) bus_->Send(kCommand);
  RunUntil([begin_s = MonotonicNow()] { return MonotonicNow() > begin_s + 0.2; });
  sent_.clear();
  guard_->Signal(SIGCONT);
  RunUntil([&] { return sent_.size() >= 5; });
  for (const std::string& frame : sent_) EXPECT_EQ(frame, "111#0000000000000000");
}

TEST_P(GuardedBusTest, AHaltIsToldAndStandsUntilItIsReleased) {
  StartGuard();
  ASSERT_TRUE(IsUp());
  ASSERT_TRUE(Sends(kCommand, "111#0064000000000000"));
  ASSERT_TRUE(RunUntil([this] { return bus_->StandingStop() == GuardStop::kSilence; }));
  EXPECT_TRUE(Sends(kCommand, "111#0000000000000000"));
  bus_->ReleaseGuard();
  EXPECT_EQ(bus_->StandingStop(), GuardStop::kNone);
  EXPECT_TRUE(Sends(kCommand, "111#0064000000000000"));
}

TEST_P(GuardedBusTest, ASecondNodeWaitsUntilTheFirstIsGone) {
  StartGuard();
  ASSERT_TRUE(IsUp());
  auto second = OpenCanBus("guard:" + bus_address_);
  EXPECT_TRUE(Sends(kCommand, "111#0064000000000000"));
  second->Receive();
  EXPECT_EQ(second->State(), CanBusState::kNoGuard);
  std::swap(second, bus_);
  second.reset();
  EXPECT_TRUE(IsUp());
}

TEST_P(GuardedBusTest, ASecondGuardAndWrongOptionsAreRefused) {
  StartGuard();
  ASSERT_TRUE(IsUp());
  const auto refuses = [&](const std::string& bus, int port,
                           const std::string& host = "127.0.0.1") {
    return StartedProcess(
               {"chassis_guard", bus, "--stop-port", std::to_string(port), "--stop-address", host})
        .Await();
  };
  const std::string other_bus = UdpAddress(FreePort(), FreePort());
  EXPECT_EQ(refuses(bus_address_, FreePort()), 1);
  EXPECT_EQ(refuses(other_bus, stop_port_), 1);
  EXPECT_EQ(refuses("udp:1", FreePort()), 1);
  EXPECT_EQ(refuses(other_bus, 70000), 2);
  EXPECT_EQ(refuses(other_bus, FreePort(), "here"), 1);
}

INSTANTIATE_TEST_SUITE_P(Bus, GuardedBusTest, ::testing::Values("udp", "vcan"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace arfm_vo
