#include <gtest/gtest.h>

#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/configuration/yaml_writer.h"
#include "arfm_vo/ros/rover/chassis_node.h"
#include "arfm_vo/ros/rover/pan_tilt_node.h"
#include "arfm_vo/ros/rover/simulator_node.h"
#include "base/number_spoiler.h"

namespace arfm_vo {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

template <class Options>
void ExpectNoInfiniteLimit() {
  const auto read = [](const Options& options) {
    Options copy;
    ReadYaml(YAML::Load(WriteYaml(options)), "", copy);
  };
  ExpectNumbersAreChecked<Options>(read, {}, kInfinite);
}

TEST(InfiniteLimits, AreRefusedByTheChassisNode) { ExpectNoInfiniteLimit<ChassisNodeOptions>(); }

TEST(InfiniteLimits, AreRefusedByTheHead) { ExpectNoInfiniteLimit<PanTiltNodeOptions>(); }

TEST(InfiniteLimits, AreRefusedByTheSimulator) {
  SimulatorNodeOptions options;
  options.max_speed_up = kInfinite;
  EXPECT_INVALID(options.Check(), "max_speed_up");
  options = SimulatorNodeOptions();
  options.max_latency_s = kInfinite;
  EXPECT_INVALID(options.Check(), "max_latency_s");
}

}  // namespace
}  // namespace arfm_vo
