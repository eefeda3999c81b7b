#include "arfm_vo/ros/rover/start_check.h"

#include <gtest/gtest.h>

#include "simulation/can_memory_bus.h"

namespace arfm_vo {
namespace {

using diagnostic_msgs::DiagnosticStatus;

class StartCheckTest : public ::testing::Test {
 protected:
  /// As a node tells it.
  void Tell(const std::string& name, uint8_t level, const std::string& message,
            const std::vector<std::pair<std::string, std::string>>& values = {}) {
    diagnostic_msgs::DiagnosticArray array;
    array.status.emplace_back();
    array.status[0].name = name;
    array.status[0].level = level;
    array.status[0].message = message;
    for (const auto& [key, value] : values) {
      array.status[0].values.emplace_back();
      array.status[0].values.back().key = key;
      array.status[0].values.back().value = value;
    }
    check_->Take(array);
  }
  void TellHead(const std::string& homed, const std::string& pan_deg) {
    Tell("head/pan_tilt_node: pan-tilt", DiagnosticStatus::OK, "settled",
         {{"homed", homed}, {"pan (deg)", pan_deg}});
  }
  /// The line of an item; empty where there is none.
  std::string Line(const std::string& item) {
    for (const CheckLine& line : check_->List(now_s_))
      if (line.item == item) return line.ToString();
    return "";
  }

  CanMemoryBus bus_;
  std::unique_ptr<CanBus> chassis_ = bus_.OpenEnd();
  ChassisDriver driver_{PilotOptions{}, bus_.OpenEnd()};
  std::optional<StartCheck> check_{std::in_place, driver_, PilotOptions(), 0.12};
  double now_s_ = 100;
};

TEST_F(StartCheckTest, WhatNobodyTellsIsNotKnownAndKeepsTheRoverFromStarting) {
  PilotOptions options;
  const std::string flaws = check_->Describe(now_s_, true);
  EXPECT_NE(flaws.find("\nnot known calibration"), std::string::npos) << flaws;
  EXPECT_NE(flaws.find("\nnot known battery"), std::string::npos) << flaws;
  options.overridden_checks = {"calibration"};
  check_.emplace(driver_, options, 0);
  EXPECT_EQ(check_->Describe(now_s_, true).find("calibration"), std::string::npos);
  EXPECT_NE(check_->Describe(now_s_, false)
                .find("not known calibration: no camera's node tells its baseline (overridden)"),
            std::string::npos);
}

TEST_F(StartCheckTest, TheBaselineIsComparedWithTheTapeMeasure) {
  const std::string name = "stereo/stereo_camera_node: calibration";
  Tell(name, DiagnosticStatus::OK, "calibrated", {{"baseline (m)", "0.1195"}, {"age (days)", "3"}});
  EXPECT_EQ(Line("calibration"),
            "yes calibration: baseline 0.1195 m, made 3 days ago; by the tape measure 0.120 m");
  Tell(name, DiagnosticStatus::OK, "calibrated", {{"baseline (m)", "0.0960"}});
  EXPECT_EQ(Line("calibration").find("no calibration: baseline 0.0960 m"), 0u);
  Tell("pose_node: calibration", DiagnosticStatus::ERROR, "rows differ by 4.00 px");
  EXPECT_EQ(Line("calibration"), "no calibration: rows differ by 4.00 px");
  check_.emplace(driver_, PilotOptions(), 0);
  Tell(name, DiagnosticStatus::OK, "calibrated", {{"baseline (m)", "0.1195"}});
  EXPECT_EQ(Line("calibration"),
            "not known calibration: baseline 0.1195 m, of unknown age; nobody has measured it "
            "(baseline_m)");
}

TEST_F(StartCheckTest, AHeadMustBeHomedAndMoved) {
  EXPECT_EQ(Line("head"), "");
  TellHead("False", "0.0");
  EXPECT_EQ(Line("head").find("not known head: was not homed"), 0u);
  TellHead("True", "0.0");
  EXPECT_EQ(Line("head"), "not known head: has not moved yet: move it by 15 deg");
  TellHead("True", "-10.0");
  TellHead("True", "0.0");
  EXPECT_EQ(Line("head"), "yes head: homed, and the picture turns with it");
  Tell("head/pan_tilt_node: pan-tilt", DiagnosticStatus::WARN, "homing");
  EXPECT_EQ(Line("head"), "no head: homing");
}

/// The belt slips: the head tells a turn, the picture shows none, and the base seems to turn back.
TEST_F(StartCheckTest, AHeadThatThePictureDoesNotFollowIsTold) {
  Pilot& pilot = driver_.pilot();
  pilot.ObserveEpoch(1, now_s_);
  TellHead("True", "0.0");
  for (int i = 0; i <= 20; ++i) {
    now_s_ += 0.1;
    const Rigid3 base(ExpSO3({0, 0, i < 10 ? 0 : -0.03 * (i - 10)}), Eigen::Vector3d::Zero());
    pilot.ObservePose(now_s_, {now_s_, base, {}});
    pilot.ObserveUncertainty(now_s_, {now_s_, 0.001, 0.001});
    driver_.Tick(now_s_);
  }
  TellHead("True", "17.2");
  EXPECT_EQ(Line("head"), "no head: the picture does not turn with it");
  now_s_ += 60;
  EXPECT_EQ(Line("head"), "yes head: homed, and the picture turns with it");
}

TEST_F(StartCheckTest, TracksThatRunAreABrakeThatIsNotOn) {
  EXPECT_EQ(Line("brake"), "not known brake: the chassis is silent");
  for (const double speed_mps : {0.02, -0.02, 0.0}) {
    chassis_->Send(EncodeFrame(MotionState{{speed_mps, 0}}));
    driver_.Tick(now_s_);
    EXPECT_EQ(Line("brake").find(speed_mps == 0 ? "yes brake" : "no brake"), 0u);
  }
}

TEST_F(StartCheckTest, ABatteryThatWarnsIsTold) {
  SystemState system;
  system.battery_v = 24.1;
  chassis_->Send(EncodeFrame(system));
  BatteryState battery;
  battery.charge_percent = 55;
  chassis_->Send(EncodeFrame(battery));
  driver_.Tick(now_s_);
  EXPECT_EQ(Line("battery"), "yes battery: 24.1 V, 55 %");
  system.error_bits = 0x0002;
  chassis_->Send(EncodeFrame(system));
  driver_.Tick(now_s_);
  EXPECT_EQ(Line("battery"), "no battery: 24.1 V, 55 %, battery warning");
}

}  // namespace
}  // namespace arfm_vo
