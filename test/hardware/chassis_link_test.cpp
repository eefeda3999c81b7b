#include "arfm_vo/hardware/chassis_link.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "arfm_vo/hardware/chassis_driver.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

/// A link at one end of a bus and the test at the other.
class ChassisLinkTest : public ::testing::Test {
 protected:
  template <class Message>
  void Say(const Message& message) {
    chassis_->Send(EncodeFrame(message));
    link_.Receive();
  }
  void SayMode(ControlMode mode) {
    SystemState state;
    state.mode = mode;
    Say(state);
  }
  /// What the link has sent since the last call.
  std::string Heard() {
    std::string text;
    while (const auto frame = chassis_->Receive())
      if (frame->kind == CanFrameKind::kData) text += ToString(*frame) + " ";
    return text;
  }

  CanMemoryBus bus_;
  std::unique_ptr<CanBus> chassis_ = bus_.OpenEnd();
  ChassisLink link_{bus_.OpenEnd()};
  const DriveCommand silent_{false, false, {}};
  const DriveCommand standing_{true, true, {}};
};

TEST_F(ChassisLinkTest, SendsTheMotionAndAsksForCanModeWhereItMaySpeak) {
  const struct {
    ControlMode mode;
    DriveCommand command;
    const char* frames;
  } rows[] = {{ControlMode::kStandby, silent_, ""},
              {ControlMode::kStandby, {true, true, {0.1, -0.2}}, "421#01 111#0064FF3800000000 "},
              {ControlMode::kCan, standing_, "111#0000000000000000 "}};
  for (const auto& [mode, command, frames] : rows) {
    SayMode(mode);
    link_.Send(0, command);
    if (!command.may_speak) link_.SendFarewell();
    EXPECT_EQ(Heard(), frames);
  }
}

TEST_F(ChassisLinkTest, TheRequestIsRepeatedUntilItIsHeard) {
  SayMode(ControlMode::kStandby);
  std::string all;
  for (int i = 0; i < 50; ++i) {
    link_.Send(0.02 * i, standing_);
    all += Heard();
  }
  int num_requests = 0;
  for (size_t at = 0; (at = all.find("421#01", at)) != std::string::npos; ++at) ++num_requests;
  EXPECT_EQ(num_requests, 5);
}

TEST_F(ChassisLinkTest, TheRemoteControlIsNotArguedWithAndTheModeIsAskedForWhenItHandsBack) {
  SayMode(ControlMode::kStandby);
  link_.Send(10.00, standing_);
  SayMode(ControlMode::kRemote);
  Heard();
  link_.Send(10.02, standing_);
  EXPECT_EQ(Heard(), "111#0000000000000000 ");
  SayMode(ControlMode::kStandby);
  link_.Send(10.04, standing_);
  EXPECT_EQ(Heard(), "421#01 111#0000000000000000 ");
}

TEST_F(ChassisLinkTest, NoSpeedAboveTheLimitGoesOut) {
  SayMode(ControlMode::kCan);
  for (const PlanarMotion& motion : {PlanarMotion{0.5, 0}, {-0.5, 0}, {0, 3}, {0, -3}})
    link_.Send(0, {true, true, motion});
  EXPECT_EQ(Heard(),
            "111#0064000000000000 111#FF9C000000000000 111#0000015E00000000 111#0000FEA200000000 ");
}

TEST_F(ChassisLinkTest, TheLampIsSwitchedOnceAndRepeatedWhileItIsOn) {
  SayMode(ControlMode::kCan);
  link_.Send(0, {true, true, {}, true});
  EXPECT_EQ(Heard(), "111#0000000000000000 121#0101000100000000 ");
  link_.Send(0.4, {true, true, {}, true});
  EXPECT_EQ(Heard(), "111#0000000000000000 ");
  link_.Send(0.5, {true, true, {}, true});
  EXPECT_EQ(Heard(), "111#0000000000000000 121#0101000100000001 ");
  link_.Send(0.6, standing_);
  EXPECT_EQ(Heard(), "111#0000000000000000 121#0100000000000002 ");
}

TEST_F(ChassisLinkTest, MotionCommandsOfAnotherDriverAreCountedAndNoFeedback) {
  chassis_->Send(EncodeFrame(MotionCommand{{0.1, 0}}));
  EXPECT_TRUE(link_.Receive().empty());
  EXPECT_EQ(link_.Traffic().num_foreign_commands, 1);
  EXPECT_EQ(link_.Traffic().num_unreadable, 0);
}

TEST_F(ChassisLinkTest, TheFarewellIsAStopAndStandby) {
  link_.Send(0, standing_);
  Heard();
  link_.SendFarewell();
  EXPECT_EQ(Heard(), "111#0000000000000000 421#00 ");
}

TEST_F(ChassisLinkTest, KeepsTheNewestReadings) {
  Say(TrackOdometer{1, 2});
  Say(TrackOdometer{3, 4});
  Say(MotorState{ChassisSide::kRight, 5, 6, 7});
  EXPECT_EQ(link_.Readings().odometer->left_mm, 3);
  EXPECT_EQ(link_.Readings().motors[1]->speed_rpm, 5);
  EXPECT_FALSE(link_.Readings().motors[0]);
  EXPECT_FALSE(link_.Readings().system);
}

TEST_F(ChassisLinkTest, GarbageAndWrongLengthsAreCountedAndNothingElse) {
  chassis_->Send(MakeCanFrame(0x211, {1, 1}));
  chassis_->Send(MakeCanFrame(0x2AB, {1, 2, 3}));
  chassis_->Send(MakeCanFrame(0x7FF, {}));
  EXPECT_TRUE(link_.Receive().empty());
  EXPECT_EQ(link_.Traffic().num_unreadable, 3);
  EXPECT_EQ(link_.Traffic().num_received, 0);
}

TEST_F(ChassisLinkTest, AFloodIsReadInBoundedBites) {
  for (int i = 0; i < 1200; ++i) chassis_->Send(EncodeFrame(TrackOdometer{i, i}));
  EXPECT_EQ(link_.Receive().size(), 500u);
  EXPECT_EQ(link_.Receive().size(), 500u);
  EXPECT_EQ(link_.Receive().size(), 200u);
  EXPECT_EQ(link_.Readings().odometer->left_mm, 1199);
}

TEST_F(ChassisLinkTest, ABusThatWentOffAndCameBackBetweenTwoCallsIsNoticed) {
  bus_.SetState(CanBusState::kBusOff);
  bus_.SetState(CanBusState::kUp);
  link_.Receive();
  EXPECT_FALSE(link_.IsBusUp());
  link_.Send(0, standing_);
  link_.Receive();
  EXPECT_TRUE(link_.IsBusUp());
  EXPECT_EQ(link_.Traffic().num_bus_off, 1);
}

TEST_F(ChassisLinkTest, AQueueThatStaysFullCountsAsDown) {
  bus_.SetBusy(true);
  link_.Send(0, standing_);
  EXPECT_TRUE(link_.IsBusUp());
  for (int i = 0; i < 3; ++i) link_.Send(0, standing_);
  EXPECT_FALSE(link_.IsBusUp());
  EXPECT_EQ(link_.Traffic().num_send_busy, 4);
  bus_.SetBusy(false);
  link_.Send(0, standing_);
  EXPECT_TRUE(link_.IsBusUp());
}

TEST(ToChassisStatus, EachErrorBitOfEitherByteIsAFaultButAWarningAndALostRemoteControl) {
  const uint32_t kNoFaults = 0x0406;  // byte 5: warning, remote control; byte 4: remote control
  for (int bit = 0; bit < 16; ++bit) {
    SystemState state;
    state.error_bits = static_cast<uint16_t>(1 << bit);
    const ChassisStatus status = ToChassisStatus(state);
    EXPECT_EQ(status.has_fault, (kNoFaults >> bit & 1) == 0) << bit;
    EXPECT_EQ(status.is_remote_lost, bit == 2 || bit == 10) << bit;
    EXPECT_NE(status.detail, "") << bit;
  }
  EXPECT_EQ(DescribeErrors(0x0011), "battery fault, motor 2 silent");
  EXPECT_EQ(DescribeErrors(0x8180), "steering encoder, battery fault or motor driver, bit 15");
  EXPECT_EQ(ToChassisStatus(SystemState{}).detail, "");
}

TEST(ChassisLink, HearsTheCommandsThatOthersSend) {
  const CanFilters filters = ChassisLink::Filters();
  for (const uint32_t id : {0x111u, 0x131u, 0x421u, 0x211u, 0x361u})
    EXPECT_TRUE(std::any_of(filters.begin(), filters.end(), [&](const CanFilter& filter) {
      return (id & filter.mask) == filter.id;
    })) << id;
}

}  // namespace
}  // namespace arfm_vo
