#include "arfm_vo/simulation/simulated_chassis.h"

#include <gtest/gtest.h>

#include "simulation/simulated_drive.h"

namespace arfm_vo {
namespace {

/// The simulated chassis with the test at the other end of the bus.
class SimulatedChassisTest : public ::testing::Test {
 protected:
  static TrackedPlantOptions WithoutSlip() {
    TrackedPlantOptions options;
    options.turn_slip_factor = 1;
    options.forward_slip = options.slip_variation = options.sideways_slip = 0;
    return options;
  }

  void Run(double duration_s) {
    const int num_ticks = static_cast<int>(std::lround(duration_s * 100));
    for (int i = 0; i < num_ticks; ++i) {
      now_s_ += 0.01;
      chassis_.Tick(now_s_);
      while (const auto frame = bus_end_->Receive()) {
        ++num_frames_[frame->id];
        const ChassisFeedback feedback = DecodeFeedback(*frame);
        if (const auto* state = std::get_if<SystemState>(&feedback)) state_ = *state;
      }
    }
  }
  template <class Message>
  void Tell(const Message& message) {
    bus_end_->Send(EncodeFrame(message));
  }
  /// Keeps telling it to drive ahead at 0.1 m/s.
  void Drive(double duration_s) {
    for (int i = 0; i < static_cast<int>(std::lround(duration_s * 50)); ++i) {
      Tell(MotionCommand{{0.1, 0}});
      Run(0.02);
    }
  }
  double X() const { return chassis_.plant().Pose().x_m; }

  CanMemoryBus bus_;
  std::unique_ptr<CanBus> bus_end_ = bus_.OpenEnd();
  SimulatedChassis chassis_{bus_.OpenEnd(), TrackedPlant(WithoutSlip(), RoverPose{})};
  double now_s_ = 50;
  std::map<uint32_t, int> num_frames_;
  SystemState state_;
};

TEST_F(SimulatedChassisTest, PowersUpInStandbyAndHearsOnlyTheMode) {
  Drive(1);
  EXPECT_EQ(X(), 0);
  EXPECT_EQ(state_.mode, ControlMode::kStandby);
  Tell(ControlModeCommand{ControlMode::kCan});
  Drive(1);
  EXPECT_GT(X(), 0.08);
  EXPECT_EQ(state_.mode, ControlMode::kCan);
}

TEST_F(SimulatedChassisTest, SendsItsFeedbackAtTheManualsRates) {
  Run(10);
  EXPECT_NEAR(num_frames_[0x221], 500, 2);
  EXPECT_NEAR(num_frames_[0x251], 500, 2);
  EXPECT_NEAR(num_frames_[0x311], 500, 2);
  EXPECT_NEAR(num_frames_[0x211], 100, 2);
  EXPECT_NEAR(num_frames_[0x361], 100, 2);
}

TEST(TrackedPlant, SkidsInTurns) {
  TrackedPlantOptions options;
  options.turn_slip_factor = 1.5;
  TrackedPlant plant(options, {});
  for (int i = 0; i < 1000; ++i) plant.Step({-0.05, 0.05}, 0.01);
  const double track_turn_rad = (plant.Ways().right_m - plant.Ways().left_m) / 0.583;
  EXPECT_NEAR(plant.Pose().heading_rad, track_turn_rad / 1.5, 1e-9);
  EXPECT_NEAR(plant.Pose().x_m, 0, 1e-9);
}

TEST(TrackedPlant, ClimbsAlongTheSlopeAndSlidesDownIt) {
  TrackedPlantOptions options;
  options.forward_slip = options.slip_variation = 0;
  const double slope_rad = 10 * M_PI / 180;
  const auto place = [slope_rad](const RoverPose& pose) {
    const Eigen::Quaterniond slope(Eigen::AngleAxisd(slope_rad, -Eigen::Vector3d::UnitY()));
    return Rigid3(slope * ExpSO3({0, 0, pose.heading_rad}),
                  Eigen::Vector3d(pose.x_m, pose.y_m, std::tan(slope_rad) * pose.x_m));
  };
  TrackedPlant up(options, {}, place);
  for (int i = 0; i < 1000; ++i) up.Step({0.1, 0.1}, 0.01);
  EXPECT_NEAR(up.Pose().x_m, up.Ways().left_m * std::cos(slope_rad), 1e-9);
  TrackedPlant across(options, {0, 0, M_PI / 2}, place);
  for (int i = 0; i < 1000; ++i) across.Step({0.1, 0.1}, 0.01);
  EXPECT_LT(across.Pose().x_m, -0.01);
  EXPECT_NEAR(across.Pose().y_m, across.Ways().left_m, 1e-6);
}

TEST(ClosedLoop, StopLookGoDrivesBySightThatComesOncePerMinute) {
  PilotOptions options;
  options.stop_look_go.is_on = true;
  options.stop_look_go.max_pose_age_s = 90;
  SimulatedDrive drive(options);
  drive.DriveAlong({{1, 0, 0.0}});
  int tick = 0;
  drive.each_tick_ = [&] { drive.has_pose_ = ++tick % 1500 < 5; };  // 0.1 s of each 30 s
  ASSERT_TRUE(drive.RunUntil(1200, [&] { return !drive.HasGoal(); }));
  EXPECT_EQ(drive.pilot().TakeResults().at(0).outcome, GoalOutcome::kArrived);
  EXPECT_NEAR(drive.plant().Pose().x_m, 1, 0.045);
}

}  // namespace
}  // namespace arfm_vo
