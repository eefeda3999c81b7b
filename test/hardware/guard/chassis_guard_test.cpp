#include "arfm_vo/hardware/guard/chassis_guard.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "arfm_vo/hardware/chassis_link.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

const CanFrame kAhead = EncodeFrame(MotionCommand{{0.1, 0}}), kZero = EncodeFrame(MotionCommand{});
constexpr char kZeroText[] = "111#0000000000000000", kAheadText[] = "111#0064000000000000";

/// A guard on simulated time, a chassis_node that speaks to it, and a chassis.
class ChassisGuardTest : public ::testing::Test {
 protected:
  /// As chassis_node sends it, `age_s` ago.
  void Command(const CanFrame& frame, double age_s = 0) {
    GuardMessage message;
    message.number = ++number_;
    message.sent_s = now_s_ - age_s;
    message.num_stops = num_released_;
    message.frame = frame;
    guard_->Take(now_s_, message);
  }
  template <class Message>
  void Say(const Message& message) {
    chassis_->Send(EncodeFrame(message));
  }
  /// The chassis is in `mode` and measures `speed_mps`; chassis_node wants `frame`; for so long.
  void Run(double duration_s, const std::optional<CanFrame>& frame, double speed_mps = 0,
           ControlMode mode = ControlMode::kCan) {
    SystemState state;
    state.mode = mode;
    for (const double end_s = now_s_ + duration_s - 1e-9; now_s_ < end_s; now_s_ += 0.02) {
      Say(state);
      Say(MotionState{{speed_mps, 0}});
      if (frame) Command(*frame);
      Tick();
    }
  }
  void Tick() {
    for (const GuardMessage& message : guard_->Tick(now_s_))
      (message.has_frame ? passed_ : status_) = message;
    while (const auto frame = chassis_->Receive())
      if (frame->kind == CanFrameKind::kData) sent_.push_back(ToString(*frame));
  }
  /// What reached the bus since the last call.
  std::vector<std::string> Sent() {
    Tick();
    return std::exchange(sent_, {});
  }
  bool HasSent(const std::string& frame) {
    const auto sent = Sent();
    return std::count(sent.begin(), sent.end(), frame) > 0;
  }

  double now_s_ = 1000;
  CanMemoryBus bus_;
  std::unique_ptr<CanBus> chassis_ = bus_.OpenEnd(), stranger_ = bus_.OpenEnd();
  GuardStop said_ = GuardStop::kNone;
  std::unique_ptr<ChassisGuard> guard_ =
      std::make_unique<ChassisGuard>(bus_.OpenEnd(), [this](GuardStop stop) { said_ = stop; });
  uint32_t number_ = 0, num_released_ = 0;
  GuardMessage status_, passed_;
  std::vector<std::string> sent_;
};

TEST_F(ChassisGuardTest, PassesOnWhatIsFreshAndNumberedRightly) {
  Command(kAhead);
  EXPECT_EQ(Sent(), std::vector<std::string>{kAheadText});
  Command(EncodeFrame(ControlModeCommand{ControlMode::kCan}));
  Command(EncodeFrame(ClearErrorsCommand{}));
  Command(EncodeFrame(LightCommand{true, 7}));
  EXPECT_EQ(Sent(), (std::vector<std::string>{"421#01", "441#00", "121#0101000100000007"}));
  Command(kAhead, 0.12);   // too old, as of a guard that was stopped
  Command(kAhead, -0.01);  // of the future: not by our clock
  number_ -= 3;
  Command(kAhead);  // repeated
  EXPECT_TRUE(Sent().empty());
}

TEST_F(ChassisGuardTest, LetsNoOtherFrameAndNoHigherSpeedThrough) {
  Command(EncodeFrame(MotionCommand{{3, -3}}));
  EXPECT_EQ(Sent(), std::vector<std::string>{"111#0064FEA200000000"});
  for (const uint32_t id : {0x0A1, 0x131, 0x211, 0x431}) Command(MakeCanFrame(id, {1, 1, 1, 1}));
  EXPECT_TRUE(Sent().empty());
}

TEST_F(ChassisGuardTest, IsSilentBeforeTheFirstMotionAndAfterAFarewell) {
  guard_->Disconnect();
  Run(1, std::nullopt, 0.2);
  EXPECT_TRUE(Sent().empty());
  guard_->Stop(GuardStop::kPacket);
  EXPECT_EQ(Sent(), std::vector<std::string>{kZeroText}) << "a stop always speaks";
  num_released_ = 1;
  Command(kZero);
  Run(0.2, std::nullopt);  // a farewell ends a silence too
  Command(EncodeFrame(ControlModeCommand{}));
  Sent();
  guard_->Disconnect();
  Run(1, std::nullopt, 0);
  EXPECT_TRUE(Sent().empty());
}

TEST_F(ChassisGuardTest, SendsZeroWhereTheNodeIsSilentFor100MsUntilItHasTakenNotice) {
  Run(1, kAhead, 0.1);
  Sent();
  for (int i = 0; i < 4; ++i, now_s_ += 0.02) Tick();  // the last command is 80 ms old then
  EXPECT_TRUE(sent_.empty());
  now_s_ += 0.02;
  EXPECT_EQ(Sent(), std::vector<std::string>{kZeroText});
  EXPECT_EQ(said_, GuardStop::kSilence);
  now_s_ += 0.02;
  Run(0.2, std::nullopt, 0);
  EXPECT_EQ(Sent().size(), 11) << "every 20 ms";
  EXPECT_EQ(status_.stop, GuardStop::kSilence);
  Command(kAhead);
  EXPECT_EQ(Sent(), std::vector<std::string>{kZeroText});
  num_released_ = status_.num_stops;
  Command(kAhead);
  EXPECT_EQ(Sent(), std::vector<std::string>{kAheadText});
  EXPECT_EQ(said_, GuardStop::kNone);
}

TEST_F(ChassisGuardTest, SendsZeroAtOnceWhereTheConnectionEndsAndCountsTheNextOneAnew) {
  Run(1, kAhead, 0.1);
  Sent();
  now_s_ += 0.02;
  guard_->Disconnect();
  EXPECT_EQ(Sent(), std::vector<std::string>{kZeroText});
  number_ = 0;
  num_released_ = status_.num_stops;
  Command(kAhead);
  EXPECT_EQ(Sent(), std::vector<std::string>{kAheadText});
}

TEST_F(ChassisGuardTest, AStopStandsUntilItIsReleasedByItsNumber) {
  Run(1, kAhead, 0.1);
  Sent();
  guard_->Stop(GuardStop::kPacket);
  EXPECT_EQ(Sent(), std::vector<std::string>{kZeroText});
  EXPECT_EQ(said_, GuardStop::kPacket);
  Run(1, kAhead, 0);
  EXPECT_EQ(status_.stop, GuardStop::kPacket);
  EXPECT_FALSE(HasSent(kAheadText));
  num_released_ = status_.num_stops;
  guard_->Stop(GuardStop::kPacket);  // while the release is under way
  Run(0.2, kAhead, 0);
  EXPECT_FALSE(HasSent(kAheadText));
  num_released_ = status_.num_stops;
  Run(0.2, kAhead, 0);
  EXPECT_TRUE(HasSent(kAheadText));
  EXPECT_EQ(status_.stop, GuardStop::kNone);
}

TEST_F(ChassisGuardTest, AnswersCommandsOfAnotherDriverWithZeroForASecond) {
  for (const char* foreign : {"111", "131", "421"}) {
    Run(1.1, kAhead, 0.1);
    Command(kAhead);
    Sent();
    stranger_->Send(MakeCanFrame(static_cast<uint32_t>(std::stoul(foreign, nullptr, 16)), {0, 90}));
    Tick();
    EXPECT_EQ(sent_.back(), kZeroText) << foreign;
    EXPECT_TRUE(IsCommand(passed_.frame)) << "chassis_node is told";
    sent_.clear();
    Run(0.9, kAhead, 0);
    EXPECT_FALSE(HasSent(kAheadText)) << foreign;
    Run(0.2, kAhead, 0);
    EXPECT_TRUE(HasSent(kAheadText)) << foreign;
  }
}

TEST_F(ChassisGuardTest, BrakesTracksThatRunFasterThanCommandedUntilReleased) {
  Run(1, kAhead, 0.1);
  Run(0.28, kAhead, 0.2);
  EXPECT_FALSE(HasSent("131#01"));
  Run(0.06, kAhead, 0.2);
  EXPECT_TRUE(HasSent("131#01"));
  EXPECT_EQ(status_.stop, GuardStop::kMotion);
  guard_->Stop(GuardStop::kPacket);
  Run(1, kAhead, 0);
  const auto sent = Sent();
  EXPECT_GE(std::count(sent.begin(), sent.end(), "131#01"), 4) << "repeated";
  EXPECT_EQ(std::count(sent.begin(), sent.end(), "131#00"), 0) << "a packet releases no brake";
  EXPECT_EQ(std::count(sent.begin(), sent.end(), kAheadText), 0);
  num_released_ = status_.num_stops;
  bus_.SetBusy(true);
  Run(0.1, kAhead, 0);
  bus_.SetBusy(false);
  Run(0.1, kAhead, 0);
  const auto released = Sent();
  EXPECT_EQ(std::count(released.begin(), released.end(), "131#00"), 1);
  EXPECT_GE(std::count(released.begin(), released.end(), kAheadText), 4);
}

TEST_F(ChassisGuardTest, BrakesARoverThatCreepsAtRestButNotOneThatRunsOut) {
  Run(2, kAhead, 0.1);
  Run(0.8, kZero, 0.04);
  Run(3, kZero, 0);
  EXPECT_FALSE(HasSent("131#01"));
  Run(2.2, kZero, 0.025);  // 5.5 cm
  EXPECT_FALSE(HasSent("131#01"));
  Run(0.2, kZero, 0.025);
  EXPECT_TRUE(HasSent("131#01"));
  num_released_ = status_.num_stops;
  Run(2, kZero, 0);
  EXPECT_EQ(status_.stop, GuardStop::kNone) << "what it went before does not count any more";
}

TEST_F(ChassisGuardTest, BrakesWhereNobodyIsLeftToCommand) {
  Run(1, kAhead, 0.1);
  guard_->Disconnect();
  Run(1.2, std::nullopt, 0.1);  // it does not obey
  EXPECT_TRUE(HasSent("131#01"));
}

TEST_F(ChassisGuardTest, DoesNotBrakeWhatTheRemoteControlMoves) {
  Run(1, kAhead, 0.1);
  Run(3, kZero, 0.5, ControlMode::kRemote);
  EXPECT_FALSE(HasSent("131#01"));
  Run(1, kZero, 0);
  EXPECT_FALSE(HasSent("131#01"));
}

TEST_F(ChassisGuardTest, PassesOnWhatTheBusSaysAndHowItIs) {
  Say(MotionState{{0.1, 0}});
  Tick();
  EXPECT_EQ(passed_.frame, EncodeFrame(MotionState{{0.1, 0}}));
  EXPECT_EQ(status_.bus, CanBusState::kUp);
  bus_.SetState(CanBusState::kDown);
  Command(kAhead);
  now_s_ += 0.02;
  Tick();
  EXPECT_EQ(status_.bus, CanBusState::kDown);
  EXPECT_EQ(status_.last_send, CanSendStatus::kDown);
}

TEST_F(ChassisGuardTest, LeavesTheRoverStandingInStandby) {
  Command(kAhead);
  Sent();
  guard_.reset();
  EXPECT_EQ(ToString(*chassis_->Receive()), kZeroText);
  EXPECT_EQ(ToString(*chassis_->Receive()), "421#00");
}

}  // namespace
}  // namespace arfm_vo
