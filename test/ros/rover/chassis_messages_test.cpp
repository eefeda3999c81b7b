#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "arfm_vo/ros/rover/chassis_publisher.h"
#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;

/// A link to a chassis that has said everything once.
class ChassisMessagesTest : public ::testing::Test {
 protected:
  ChassisMessagesTest() {
    SystemState system;
    system.mode = ControlMode::kCan;
    system.battery_v = 28.7;
    Say(system);
    Say(MotionState{{0.1, -0.2}});
    Say(TrackOdometer{1500, -250});
    Say(MotorState{ChassisSide::kRight, 12, 1.5, 0});
    Say(MotorDriverState{ChassisSide::kLeft, 28, 40, 35, 0x40});
    Say(BatteryState{88, 99, 28.6, -2.5, 21});
  }
  template <class Message>
  void Say(const Message& message) {
    chassis_->Send(EncodeFrame(message));
    link_.Receive();
  }
  DiagnosticStatus Diagnose(DriveState state, StopReason reason) {
    PilotStatus status;
    status.state = state;
    status.reason = reason;
    diagnostic_updater::DiagnosticStatusWrapper diagnostics;
    FillDiagnostics(status, link_, diagnostics);
    return diagnostics;
  }

  CanMemoryBus bus_;
  std::unique_ptr<CanBus> chassis_ = bus_.OpenEnd();
  ChassisLink link_{bus_.OpenEnd()};
};

TEST_F(ChassisMessagesTest, TheStateHoldsEveryReading) {
  chassis_->Send(MakeCanFrame(0x2FF, {1}));
  link_.Receive();
  const ChassisState state = ToChassisMessage(link_);
  EXPECT_EQ(state.vehicle, ChassisState::VEHICLE_OK);
  EXPECT_EQ(state.mode, ChassisState::MODE_CAN);
  EXPECT_NEAR(state.battery_v, 28.7, 1e-9);
  EXPECT_NEAR(state.forward_mps, 0.1, 1e-9);
  EXPECT_NEAR(state.left_track_m, 1.5, 1e-9);
  EXPECT_NEAR(state.right_track_m, -0.25, 1e-9);
  EXPECT_EQ(state.motor_rpm[1], 12);
  EXPECT_EQ(state.driver_celsius[0], 40);
  EXPECT_EQ(state.bus, "up");
  EXPECT_EQ(state.num_frames_received, 6u);
  EXPECT_EQ(state.num_frames_unreadable, 1u);
}

TEST_F(ChassisMessagesTest, TheBatteryIsAFractionAndWhatIsUnknownNotANumber) {
  const auto battery = ToBatteryMessage(link_.Readings());
  EXPECT_NEAR(battery.percentage, 0.88, 1e-6);
  EXPECT_NEAR(battery.voltage, 28.6, 1e-5);
  EXPECT_NEAR(battery.current, -2.5, 1e-6);
  EXPECT_TRUE(battery.present);
  EXPECT_TRUE(std::isnan(battery.capacity));
  EXPECT_TRUE(std::isnan(ToBatteryMessage(ChassisReadings{}).percentage));
}

TEST_F(ChassisMessagesTest, StandingForAFaultIsAnErrorAndForAReasonAWarning) {
  EXPECT_EQ(Diagnose(DriveState::kDriving, StopReason::kNone).level, DiagnosticStatus::OK);
  EXPECT_EQ(Diagnose(DriveState::kStandby, StopReason::kNotStarted).level, DiagnosticStatus::WARN);
  const DiagnosticStatus blocked = Diagnose(DriveState::kBlocked, StopReason::kSlip);
  EXPECT_EQ(blocked.level, DiagnosticStatus::ERROR);
  EXPECT_EQ(blocked.message, "blocked: too much slip");
}

TEST_F(ChassisMessagesTest, ABusThatIsOffIsAnErrorWhateverThePilotDoes) {
  bus_.SetState(CanBusState::kBusOff);
  const DiagnosticStatus status = Diagnose(DriveState::kStandby, StopReason::kNotStarted);
  EXPECT_EQ(status.level, DiagnosticStatus::ERROR);
  EXPECT_NE(status.message.find("CAN bus is bus-off"), std::string::npos) << status.message;
}

TEST(ChassisDiagnosis, SaysWhetherThereIsAGuardAndWhyItStops) {
  const std::pair<std::optional<GuardStop>, std::string> rows[] = {
      {std::nullopt, "none"},
      {GuardStop::kNone, "watches"},
      {GuardStop::kPacket, "stops: a UDP packet"}};
  for (const auto& [stop, text] : rows) {
    CanMemoryBus bus;
    bus.SetGuardStop(stop);
    const ChassisLink link(bus.OpenEnd());
    diagnostic_updater::DiagnosticStatusWrapper diagnostics;
    FillDiagnostics(PilotStatus(), link, diagnostics);
    const auto is_guard = [](const auto& value) { return value.key == "chassis_guard"; };
    const auto& values = diagnostics.values;
    const auto value = std::find_if(values.begin(), values.end(), is_guard);
    ASSERT_NE(value, values.end());
    EXPECT_EQ(value->value, text);
  }
}

TEST_F(ChassisMessagesTest, ALowBatteryIsAWarning) {
  SystemState system;
  system.error_bits = kBatteryWarning;
  Say(system);
  EXPECT_EQ(Diagnose(DriveState::kDriving, StopReason::kNone).level, DiagnosticStatus::WARN);
}

TEST(GoalReport, SaysTheOutcomeAndTheReason) {
  const GoalReport report =
      ToMessage(GoalResult{GoalOutcome::kBlocked, StopReason::kBusDown, "", {3, 4, 0.5}, 1.5, 0.1});
  EXPECT_EQ(report.result, GoalReport::BLOCKED);
  EXPECT_EQ(report.text, "blocked: CAN bus is down");
  EXPECT_EQ(report.x_m, 3);
  EXPECT_EQ(report.position_error_m, 1.5);
  EXPECT_EQ(RefusedGoal("goal refused: x").result, GoalReport::REFUSED);
}

TEST(TrackSlipMessage, MarksWhatCouldNotBeJudged) {
  Slip slip;
  slip.forward_ratio = 0.25;
  const TrackSlip message = ToMessage(slip);
  EXPECT_TRUE(message.has_forward_ratio);
  EXPECT_EQ(message.forward_ratio, 0.25);
  EXPECT_FALSE(message.has_turn_ratio);
}

}  // namespace
}  // namespace arfm_vo
