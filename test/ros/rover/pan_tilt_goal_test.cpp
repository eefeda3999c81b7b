#include <gmock/gmock.h>

#include <cmath>

#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/ros/rover/pan_tilt_node.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

sensor_msgs::JointState Command(std::vector<std::string> names, std::vector<double> positions) {
  sensor_msgs::JointState command;
  command.name = std::move(names);
  command.position = std::move(positions);
  return command;
}

std::string Refusal(const sensor_msgs::JointState& command) {
  return RefusalOf([&] { ReadGoal(command, {}); });
}

TEST(PanTiltGoal, JointsAreTakenByNameInAnyOrder) {
  const PanTiltGoal both = ReadGoal(Command({"tilt", "pan"}, {0.1, -0.2}), {});
  EXPECT_EQ(both.tilt_rad, 0.1);
  EXPECT_EQ(both.pan_rad, -0.2);
  const PanTiltGoal one = ReadGoal(Command({"tilt"}, {0.1}), {});
  EXPECT_FALSE(one.pan_rad);
}

TEST(PanTiltGoal, WrongCommandsSayWhatIsWrong) {
  using testing::HasSubstr;
  EXPECT_THAT(Refusal(Command({}, {0.1})), HasSubstr("names no joint"));
  EXPECT_THAT(Refusal(Command({"pan", "tilt"}, {0.1})), HasSubstr("a position"));
  EXPECT_THAT(Refusal(Command({"yaw"}, {0.1})), HasSubstr("no joint \"yaw\""));
  EXPECT_THAT(Refusal(Command({"pan", "pan"}, {0.1, 0.2})), HasSubstr("twice"));
  EXPECT_THAT(Refusal(Command({"pan"}, {NAN})), HasSubstr("no number"));
  sensor_msgs::JointState fast = Command({"pan"}, {0.1});
  fast.velocity = {0.5};
  EXPECT_THAT(Refusal(fast), HasSubstr("pan_speed_rad_s"));
}

TEST(AngleAt, LiesOnTheLineBetweenTwoReadings) {
  const PtuReading before{1, 10}, after{2, 10.5};
  EXPECT_DOUBLE_EQ(*AngleAt(10.125, before, after), 1.25);
  EXPECT_FALSE(AngleAt(9.9, before, after));
  EXPECT_FALSE(AngleAt(10.6, before, after));
  EXPECT_FALSE(AngleAt(10.2, std::nullopt, after));
}

TEST(PanTiltNodeOptions, ShippedConfigIsReadStrictly) {
  const auto options =
      ReadYamlFile<PanTiltNodeOptions>(std::string(ARFM_VO_SOURCE_DIR) + "/config/pan_tilt.yaml");
  EXPECT_EQ(options.port, "/dev/ttyUSB0");
  EXPECT_FALSE(options.unit.home_at_start);
}

}  // namespace
}  // namespace arfm_vo
