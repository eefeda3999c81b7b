#include "arfm_vo/hardware/chassis_driver.h"

#include <gtest/gtest.h>

#include <cstdio>

#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

/// A driver that hears a chassis in CAN mode, of which a test spoils a frame.
class ChassisDriverTest : public ::testing::Test {
 protected:
  static PilotOptions Options() {
    PilotOptions options;
    options.operator_watch.is_required = false;
    options.velocity_needs_pose = false;
    return options;
  }
  /// All kinds of feedback but those of the identifier `silent`; says what a start says.
  std::string Start(uint32_t silent = 0) {
    SystemState state;
    state.mode = ControlMode::kCan;
    state.error_bits = error_bits_;
    state.count = count_++;
    std::vector<CanFrame> frames = {EncodeFrame(state), EncodeFrame(MotionState{}),
                                    EncodeFrame(TrackOdometer{})};
    for (const ChassisSide side : {ChassisSide::kLeft, ChassisSide::kRight}) {
      frames.push_back(EncodeFrame(MotorState{side, 0, 0, 0}));
      frames.push_back(EncodeFrame(MotorDriverState{side, 28, 40, 35, motor_status_}));
    }
    for (const CanFrame& frame : frames)
      if (frame.id != silent) chassis_->Send(frame);
    driver_.Tick(now_s_);
    return driver_.pilot().Start(now_s_).text;
  }

  CanMemoryBus bus_;
  std::unique_ptr<CanBus> chassis_ = bus_.OpenEnd();
  ChassisDriver driver_{Options(), bus_.OpenEnd()};
  double now_s_ = 10;
  uint16_t error_bits_ = 0;
  uint8_t motor_status_ = 0x40, count_ = 0;
};

TEST_F(ChassisDriverTest, EachKindOfFeedbackIsMissedByItself) {
  const std::pair<uint32_t, std::string> kKinds[] = {
      {0x211, "system state"}, {0x221, "motion"},      {0x311, "track odometer"},
      {0x251, "left motor"},   {0x252, "right motor"}, {0x261, "left driver"},
      {0x262, "right driver"}};
  ASSERT_EQ(Start(), "started");
  for (const auto& [id, name] : kKinds) {
    now_s_ += 0.3;
    EXPECT_EQ(Start(id), "already started") << name;
    now_s_ += 0.3;
    EXPECT_EQ(Start(id), "not started: chassis is silent (" + name + ": for 0.6 s)");
    driver_.pilot().Stop();
    EXPECT_EQ(Start(), "started") << name;
  }
}

TEST_F(ChassisDriverTest, AChassisThatTellsNoMotionIsNotStarted) {
  EXPECT_EQ(Start(0x221), "not started: chassis is silent (motion: not heard yet)");
}

TEST_F(ChassisDriverTest, ErrorsAndHeatForbidTheStartAndAreNamed) {
  error_bits_ = 0x0008;
  EXPECT_EQ(Start(), "not started: chassis reports a fault motor 1 silent");
  error_bits_ = 0;
  motor_status_ = 0x4A;
  EXPECT_EQ((Start(), Start()),
            "not started: motor or its driver reports a fault left: motor too hot, driver too hot, "
            "right: motor too hot, driver too hot");
}

TEST_F(ChassisDriverTest, AHaltByTheGuardIsReleasedAndPausesTheDriveAndNoOtherStopIs) {
  const auto drive = [this] {
    driver_.pilot().SetVelocity(now_s_, {0.1, 0}, "joystick");
    Start();
    driver_.pilot().SetVelocity(now_s_, {0.1, 0}, "joystick");
    driver_.Tick(now_s_ += 0.02);
    return driver_.pilot().Status().state;
  };
  ASSERT_EQ((Start(), drive()), DriveState::kDriving);
  bus_.SetGuardStop(GuardStop::kSilence);
  EXPECT_EQ(drive(), DriveState::kPaused);
  EXPECT_EQ(driver_.pilot().Status().reason, StopReason::kHeldUp);
  EXPECT_EQ(chassis_->StandingStop(), GuardStop::kNone);
  bus_.SetGuardStop(GuardStop::kPacket);
  EXPECT_EQ(drive(), DriveState::kBlocked);
  EXPECT_EQ(chassis_->StandingStop(), GuardStop::kPacket) << "until a person starts it";
  driver_.ReleaseGuard();
  now_s_ += 0.2;  // nobody commands a velocity any more
  EXPECT_EQ(Start(), "started");
}

TEST_F(ChassisDriverTest, EachCommandOfAnotherDriverForbidsTheStart) {
  for (const uint32_t id : {0x111u, 0x131u, 0x421u}) {
    ASSERT_EQ(Start(), "started");
    driver_.pilot().Stop();
    chassis_->Send(MakeCanFrame(id, {1}));
    char name[8];
    std::snprintf(name, sizeof(name), "(0x%03X)", id);
    EXPECT_EQ(Start(), std::string("not started: another driver commands the chassis ") + name);
    now_s_ += 1.1;
    Start();
    driver_.pilot().Stop();
  }
  chassis_->Send(MakeCanFrame(0x121, {1}));
  EXPECT_EQ(Start(), "started") << "the lamp moves nothing";
}

}  // namespace
}  // namespace arfm_vo
