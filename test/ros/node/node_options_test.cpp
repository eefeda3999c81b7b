#include <gtest/gtest.h>

#include <string>

#include "arfm_vo/configuration/yaml_reader.h"
#include "arfm_vo/configuration/yaml_writer.h"
#include "arfm_vo/ros/odometry/arfm_node.h"
#include "arfm_vo/ros/odometry/ba_node.h"
#include "arfm_vo/ros/odometry/pose_node.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

/// What reading says of options of which `change` made one wrong.
template <class Options, class Change>
void ExpectOptionRefused(const Change& change, const std::string& text) {
  Options options, read;
  EXPECT_NO_THROW(ReadYaml(YAML::Load(WriteYaml(options)), "", read));
  change(options);
  EXPECT_INVALID(ReadYaml(YAML::Load(WriteYaml(options)), "", read), text);
}

TEST(PoseNodeOptions, EachPartIsChecked) {
  using Options = PoseNodeOptions;
  ExpectOptionRefused<Options>([](auto& o) { o.algorithm.odometry.min_points_to_start = 3; },
                               "min_points_to_start");
  ExpectOptionRefused<Options>([](auto& o) { o.mount.max_slew_dps = -1; }, "max_slew_dps");
  ExpectOptionRefused<Options>([](auto& o) { o.output.odom_frame = ""; }, "odom_frame");
  ExpectOptionRefused<Options>([](auto& o) { o.max_waiting_pairs = 0; }, "max_waiting_pairs");
  ExpectOptionRefused<Options>([](auto& o) { o.max_held_pairs = -1; }, "max_held_pairs");
}

TEST(ArfmNodeOptions, EachPartIsChecked) {
  using Options = ArfmNodeOptions;
  ExpectOptionRefused<Options>([](auto& o) { o.algorithm.frontend.surf.threads = 0; }, "threads");
  ExpectOptionRefused<Options>([](auto& o) { o.max_waiting_pairs = 0; }, "max_waiting_pairs");
}

TEST(BaNodeOptions, TheAlgorithmIsChecked) {
  ExpectOptionRefused<BaNodeOptions>([](auto& o) { o.algorithm.global.min_observations = 1; },
                                     "min_observations");
}

}  // namespace
}  // namespace arfm_vo
