#include "arfm_vo/hardware/chassis_protocol.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "arfm_vo/base/random.h"
#include "arfm_vo/hardware/chassis_driver.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string MotionText(double forward_mps, double turn_radps) {
  return ToString(EncodeFrame(MotionCommand{{forward_mps, turn_radps}}));
}

TEST(ChassisProtocol, MotionIsAsTheManualHasItAndSaturatesInsteadOfWrapping) {
  const struct {
    double forward_mps, turn_radps;
    const char* frame;
  } rows[] = {{0.15, 0, "111#0096000000000000"},
              {0, 0.2, "111#000000C800000000"},
              {0.1, 0, "111#0064000000000000"},
              {-0.1, -0.2, "111#FF9CFF3800000000"},
              {0, 0, "111#0000000000000000"},
              {40, -40, "111#7FFF800000000000"},
              {kInfinity, -kInfinity, "111#7FFF800000000000"},
              {1e300, -1e300, "111#7FFF800000000000"},
              {32.767, -32.768, "111#7FFF800000000000"},
              {32.766, -32.767, "111#7FFE800100000000"}};
  for (const auto& [forward_mps, turn_radps, frame] : rows)
    EXPECT_EQ(MotionText(forward_mps, turn_radps), frame);
}

TEST(ChassisProtocol, ModeAndClearCommandsAreOneByte) {
  EXPECT_EQ(ToString(EncodeFrame(ControlModeCommand{ControlMode::kCan})), "421#01");
  EXPECT_EQ(ToString(EncodeFrame(ControlModeCommand{ControlMode::kStandby})), "421#00");
  EXPECT_EQ(ToString(EncodeFrame(ClearErrorsCommand{})), "441#00");
}

TEST(ChassisProtocol, NotANumberIsStandingStill) {
  EXPECT_EQ(MotionText(kNaN, kNaN), "111#0000000000000000");
}

TEST(ChassisProtocol, EveryFieldOfTheFeedbackSaturates) {
  EXPECT_EQ(ToString(EncodeFrame(MotionState{{99, -99}})), "221#7FFF800000000000");
  EXPECT_EQ(ToString(EncodeFrame(MotorState{ChassisSide::kRight, 70000, 1e6, 1})),
            "252#7FFF7FFF00000001");
  EXPECT_EQ(ToString(EncodeFrame(MotorState{ChassisSide::kLeft, -70000, -1e6, -1})),
            "251#80008000FFFFFFFF");
  EXPECT_EQ(ToString(EncodeFrame(MotorDriverState{ChassisSide::kLeft, 1e9, 70000, 300, 1})),
            "261#FFFF7FFF7F010000");
  EXPECT_EQ(ToString(EncodeFrame(MotorDriverState{ChassisSide::kRight, -5, -70000, -300, 1})),
            "262#0000800080010000");
  EXPECT_EQ(ToString(EncodeFrame(BatteryState{300, 300, 1e6, 1e6, 1e6})), "361#FFFFFFFF7FFF7FFF");
  EXPECT_EQ(ToString(EncodeFrame(BatteryState{-3, -3, -1, -1e6, -1e6})), "361#0000000080008000");
}

TEST(ChassisProtocol, ReadsTheSystemState) {
  const CanFrame frame = MakeCanFrame(0x211, {1, 3, 0x01, 0x1F, 0x05, 0x02, 0, 0x2A});
  const auto state = std::get<SystemState>(DecodeFeedback(frame));
  EXPECT_EQ(state.vehicle, VehicleState::kEmergencyStop);
  EXPECT_EQ(state.mode, ControlMode::kRemote);
  EXPECT_NEAR(state.battery_v, 28.7, 1e-9);
  EXPECT_EQ(state.error_bits, (0x0100 | 0x0400 | 0x0002));
  EXPECT_EQ(state.count, 42);
}

TEST(ChassisProtocol, AnUnnamedVehicleStateIsAFaultAndAnUnnamedModeIsNotCan) {
  const CanFrame frame = MakeCanFrame(0x211, {9, 9, 0, 0, 0, 0, 0, 0});
  const auto state = std::get<SystemState>(DecodeFeedback(frame));
  EXPECT_EQ(state.vehicle, VehicleState::kFault);
  EXPECT_EQ(state.mode, ControlMode::kUnknown);
}

TEST(ChassisProtocol, ReadsMotionAndTrackOdometer) {
  const auto motion =
      std::get<MotionState>(DecodeFeedback(MakeCanFrame(0x221, {0xFF, 0x9C, 0, 0xC8, 0, 0, 0, 0})));
  EXPECT_DOUBLE_EQ(motion.motion.forward_mps, -0.1);
  EXPECT_DOUBLE_EQ(motion.motion.turn_radps, 0.2);
  const auto odometer = std::get<TrackOdometer>(
      DecodeFeedback(MakeCanFrame(0x311, {0xFF, 0xFF, 0xFF, 0xFE, 0x00, 0x01, 0x00, 0x00})));
  EXPECT_EQ(odometer.left_mm, -2);
  EXPECT_EQ(odometer.right_mm, 65536);
}

TEST(ChassisProtocol, ReadsMotorsDriversAndBattery) {
  const auto motor = std::get<MotorState>(
      DecodeFeedback(MakeCanFrame(0x252, {0xFF, 0xFE, 0x00, 0x0F, 0x80, 0, 0, 0})));
  EXPECT_EQ(motor.side, ChassisSide::kRight);
  EXPECT_EQ(motor.speed_rpm, -2);
  EXPECT_NEAR(motor.current_a, 1.5, 1e-9);
  EXPECT_EQ(motor.pulses, std::numeric_limits<int32_t>::min());
  const auto driver = std::get<MotorDriverState>(
      DecodeFeedback(MakeCanFrame(0x261, {0x01, 0x1F, 0xFF, 0xF6, 0x9C, 0x40, 0, 0})));
  EXPECT_NEAR(driver.supply_v, 28.7, 1e-9);
  EXPECT_EQ(driver.driver_celsius, -10);
  EXPECT_EQ(driver.motor_celsius, -100);
  EXPECT_EQ(driver.status_bits, 0x40);
  const auto battery = std::get<BatteryState>(
      DecodeFeedback(MakeCanFrame(0x361, {88, 99, 0x01, 0x1F, 0xFF, 0xCE, 0xFF, 0x9C})));
  EXPECT_EQ(battery.charge_percent, 88);
  EXPECT_EQ(battery.health_percent, 99);
  EXPECT_NEAR(battery.voltage_v, 28.7, 1e-9);
  EXPECT_NEAR(battery.current_a, -5.0, 1e-9);
  EXPECT_NEAR(battery.temperature_celsius, -10.0, 1e-9);
}

TEST(ChassisProtocol, FramesOfAnotherLengthSayNothing) {
  for (const uint32_t id : {0x211, 0x251, 0x311, 0x361}) {
    CanFrame frame = MakeCanFrame(id, {0, 1, 0, 0, 0, 0, 0});
    EXPECT_EQ(DecodeFeedback(frame).index(), 0u) << std::hex << id;
  }
  CanFrame frame = MakeCanFrame(0x311, {0, 0, 0, 1, 0, 0, 0, 1});
  frame.dlc = 15;
  EXPECT_EQ(DecodeFeedback(frame).index(), 0u);
  EXPECT_EQ(DecodeFeedback(MakeCanFrame(0x221, {0, 1, 0})).index(), 0u);
  EXPECT_EQ(DecodeFeedback(MakeCanFrame(0x262, {0, 1, 0, 0, 0})).index(), 0u);
  EXPECT_EQ(DecodeCommand(MakeCanFrame(0x111, {0, 1, 0})).index(), 0u);
  EXPECT_EQ(DecodeCommand(MakeCanFrame(0x421, {})).index(), 0u);
}

TEST(ChassisProtocol, OnlyDataFramesCarryTheProtocol) {
  for (const CanFrameKind kind : {CanFrameKind::kOther, CanFrameKind::kBusOff,
                                  CanFrameKind::kRestarted, CanFrameKind::kError}) {
    CanFrame feedback = MakeCanFrame(0x311, {0, 0, 0, 1, 0, 0, 0, 1});
    feedback.kind = kind;
    EXPECT_EQ(DecodeFeedback(feedback).index(), 0u);
    CanFrame command = EncodeFrame(ControlModeCommand{ControlMode::kCan});
    command.kind = kind;
    EXPECT_EQ(DecodeCommand(command).index(), 0u);
  }
}

/// The frame that `message` would be sent as; of monostate, one that no message has.
template <class Message>
std::string EncodedAgain(const Message& message) {
  return std::visit(
      [](const auto& value) -> std::string {
        if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::monostate>)
          return "none";
        else
          return ToString(EncodeFrame(value));
      },
      message);
}

const std::vector<uint32_t> kProtocolIds = {0x111, 0x121, 0x211, 0x221, 0x251, 0x252,
                                            0x261, 0x262, 0x311, 0x361, 0x421, 0x441};
/// What the chassis measures; whatever it holds, it moves nothing.
const std::vector<uint32_t> kMeasuredIds = {0x221, 0x251, 0x252, 0x311, 0x361};

/// Of all kinds, identifiers, lengths and bytes; half of them of the protocol.
CanFrame RandomFrame(RandomEngine& engine, const std::vector<uint32_t>& ids = kProtocolIds) {
  const auto draw = [&](uint32_t bound) { return RandomBelow(bound, engine); };
  CanFrame frame;
  frame.id = draw(2) == 0 ? ids[draw(static_cast<uint32_t>(ids.size()))] : engine();
  frame.kind = static_cast<CanFrameKind>(draw(8) == 0 ? draw(5) : 0);
  frame.dlc = static_cast<uint8_t>(draw(10) == 0 ? draw(256) : draw(9));
  for (uint8_t& byte : frame.bytes) byte = static_cast<uint8_t>(engine());
  return frame;
}

TEST(ChassisProtocolFuzz, AMillionRandomFramesAreReadWithinTheirDlc) {
  RandomEngine engine(20240611);
  int num_decoded = 0;
  for (int i = 0; i < 1000000; ++i) {
    const CanFrame frame = RandomFrame(engine);
    CanFrame other_tail = frame;
    for (size_t k = frame.dlc; k < frame.bytes.size(); ++k) other_tail.bytes[k] ^= 0xFF;
    const ChassisFeedback feedback = DecodeFeedback(frame);
    const ChassisCommand command = DecodeCommand(frame);
    ASSERT_EQ(EncodedAgain(feedback), EncodedAgain(DecodeFeedback(other_tail))) << ToString(frame);
    ASSERT_EQ(EncodedAgain(command), EncodedAgain(DecodeCommand(other_tail))) << ToString(frame);
    num_decoded += feedback.index() != 0 || command.index() != 0;
  }
  EXPECT_GT(num_decoded, 50000);
}

TEST(ChassisProtocolFuzz, WhatIsEncodedIsDecodedTheSame) {
  RandomEngine engine(7);
  for (int i = 0; i < 20000; ++i) {
    const ChassisFeedback feedback = DecodeFeedback(RandomFrame(engine));
    std::visit(
        [](const auto& message) {
          if constexpr (!std::is_same_v<std::decay_t<decltype(message)>, std::monostate>) {
            const CanFrame frame = EncodeFrame(message);
            EXPECT_EQ(EncodedAgain(DecodeFeedback(frame)), ToString(frame));
          }
        },
        feedback);
  }
}

constexpr int kNumFrames = 500000;  // in each of two tests

TEST(ChassisFuzz, NoFrameMovesARoverThatIsNotStarted) {
  CanMemoryBus bus;
  const auto other = bus.OpenEnd();
  ChassisDriver driver(PilotOptions{}, bus.OpenEnd());
  RandomEngine engine(1);
  for (int i = 0; i < kNumFrames; ++i) {
    other->Send(RandomFrame(engine));
    if (i % 100 == 0) driver.Tick(10 + 0.0002 * i);
    ASSERT_FALSE(other->Receive()) << "frame " << i;
  }
}

TEST(ChassisFuzz, NoFrameMakesAStartedRoverExceedItsLimits) {
  CanMemoryBus bus;
  const auto other = bus.OpenEnd();
  PilotOptions options;
  options.operator_watch.is_required = false;
  options.velocity_needs_pose = false;
  ChassisDriver driver(options, bus.OpenEnd());
  RandomEngine engine(2);
  int num_moving = 0;
  for (int i = 0; i < kNumFrames; ++i) {
    other->Send(RandomFrame(engine, kMeasuredIds));
    if (i % 20 != 0) continue;
    const double now_s = 10 + 0.001 * i;
    SystemState state;
    state.mode = ControlMode::kCan;
    state.count = static_cast<uint8_t>(i / 20);
    other->Send(EncodeFrame(state));
    driver.pilot().SetVelocity(now_s, {});  // no start while a velocity is commanded
    driver.pilot().Start(now_s);            // whenever a fuzzed frame has blocked it
    driver.pilot().SetVelocity(now_s, {0.1, 0});
    driver.Tick(now_s);
    while (const auto frame = other->Receive()) {
      const ChassisCommand command = DecodeCommand(*frame);
      const auto* motion = std::get_if<MotionCommand>(&command);
      if (!motion) continue;
      num_moving += !motion->motion.IsZero();
      ASSERT_LE(std::abs(motion->motion.forward_mps), kMaxSpeed_mps);
      ASSERT_LE(std::abs(motion->motion.turn_radps), 0.35);
    }
  }
  EXPECT_GT(num_moving, 0);
}

}  // namespace
}  // namespace arfm_vo
