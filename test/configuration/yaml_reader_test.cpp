#include "arfm_vo/configuration/yaml_reader.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "arfm_vo/base/fields.h"
#include "arfm_vo/base/ransac.h"
#include "arfm_vo/configuration/yaml_writer.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

enum class Solver { kDogleg, kNewton };
std::vector<std::pair<std::string, Solver>> ListNames(Solver) {
  return {{"dogleg", Solver::kDogleg}, {"newton", Solver::kNewton}};
}

struct LayerOptions {
  double scale = 1.2;
  RansacOptions ransac;
  void Check() const { Require(scale != 0, "scale must not be 0"); }
  ARFM_FIELDS(scale, ransac)
};

struct WholeOptions {
  bool enabled = false;
  int count = 3;
  uint8_t level = 7;
  double ratio = 1e-5;
  std::string name = "left";
  Solver solver = Solver::kDogleg;
  std::vector<double> lengths_m = {10, 20};
  std::array<int, 2> size = {20, 10};
  std::vector<LayerOptions> layers;
  LayerOptions pose;

  void Check() const { Require(count > 0, "count must be positive"); }
  ARFM_FIELDS(enabled, count, level, ratio, name, solver, lengths_m, size, layers, pose)
};

WholeOptions Read(const std::string& text) {
  WholeOptions options;
  ReadYaml(YAML::Load(text), "file.yaml", options);
  return options;
}

/// What reading `text` complains of.
std::string ErrorOf(const std::string& text) {
  return RefusalOf([&] { Read(text); });
}

TEST(YamlReader, ReadsEveryKindOfField) {
  const WholeOptions options = Read(
      "enabled: true\ncount: +12\nlevel: 255\nratio: 2.5e-3\nname: 'right'\nsolver: newton\n"
      "lengths_m: [1, 2.5, .inf]\nsize: [7, -8]\nlayers: [{scale: 3}, {ransac: {seed: 9}}]\n"
      "pose: {scale: 4, ransac: {max_iterations: 77}}\n");
  EXPECT_TRUE(options.enabled);
  EXPECT_EQ(options.count, 12);
  EXPECT_EQ(options.level, 255);
  EXPECT_EQ(options.ratio, 2.5e-3);
  EXPECT_EQ(options.name, "right");
  EXPECT_EQ(options.solver, Solver::kNewton);
  EXPECT_EQ(options.lengths_m, (std::vector<double>{1, 2.5, HUGE_VAL}));
  EXPECT_EQ(options.size, (std::array<int, 2>{7, -8}));
  ASSERT_EQ(options.layers.size(), 2u);
  EXPECT_EQ(options.layers[0].scale, 3);
  EXPECT_EQ(options.layers[1].ransac.seed, 9);
  EXPECT_EQ(options.pose.ransac.max_iterations, 77);
}

TEST(YamlReader, KeysLeftOutKeepTheirDefaults) {
  EXPECT_EQ(Read("").count, 3);
  const WholeOptions options = Read("pose: {scale: 4}");
  EXPECT_EQ(options.pose.ransac.max_iterations, RansacOptions{}.max_iterations);
  EXPECT_EQ(options.ratio, 1e-5);
}

TEST(YamlReader, NamesAnUnknownKeyWithItsFullNameAndLine) {
  EXPECT_EQ(
      ErrorOf("count: 1\npose:\n  ransac:\n    max_iteration: 5\n"),
      "file.yaml:4: pose.ransac.max_iteration: unknown key; known here: max_iterations, seed");
  EXPECT_THAT(ErrorOf("layers: [{scale: 3}, {skale: 3}]"),
              testing::HasSubstr("file.yaml:1: layers[1].skale: unknown key"));
}

TEST(YamlReader, NamesAKeyThatStandsTwice) {
  EXPECT_EQ(ErrorOf("count: 1\nname: a\ncount: 2\n"), "file.yaml:3: count: stands twice");
  EXPECT_EQ(ErrorOf("pose:\n  scale: 1\n  scale: 1\n"), "file.yaml:3: pose.scale: stands twice");
}

TEST(YamlReader, NamesAValueOfTheWrongType) {
  EXPECT_EQ(ErrorOf("count: 2.5"), "file.yaml:1: count: must be an integer, is 2.5");
  EXPECT_EQ(ErrorOf("count: \"2\""), "file.yaml:1: count: must be an integer, is \"2\"");
  EXPECT_EQ(ErrorOf("count: 99999999999"),
            "file.yaml:1: count: must be an integer in -2147483648..2147483647, is 99999999999");
  EXPECT_EQ(ErrorOf("level: -1"), "file.yaml:1: level: must be an integer in 0..255, is -1");
  EXPECT_EQ(ErrorOf("ratio: half"), "file.yaml:1: ratio: must be a number, is half");
  EXPECT_EQ(ErrorOf("ratio: .nan"), "file.yaml:1: ratio: must be a number, is .nan");
  EXPECT_EQ(ErrorOf("ratio: nan"), "file.yaml:1: ratio: must be a number, is nan");
  EXPECT_EQ(ErrorOf("ratio: +-1"), "file.yaml:1: ratio: must be a number, is +-1");
  EXPECT_EQ(ErrorOf("ratio:"), "file.yaml:1: ratio: must be a number, is empty");
  EXPECT_EQ(ErrorOf("enabled: 1"), "file.yaml:1: enabled: must be true or false, is 1");
  EXPECT_EQ(ErrorOf("solver: lm"), "file.yaml:1: solver: must be one of dogleg, newton, is lm");
  EXPECT_EQ(ErrorOf("lengths_m: 3"), "file.yaml:1: lengths_m: must be a list");
  EXPECT_EQ(ErrorOf("lengths_m: [1, x]"), "file.yaml:1: lengths_m[1]: must be a number, is x");
  EXPECT_EQ(ErrorOf("size: [1, 2, 3]"), "file.yaml:1: size: must be a list of 2");
  EXPECT_EQ(ErrorOf("pose: 3"), "file.yaml:1: pose: must be a map of options");
  EXPECT_EQ(ErrorOf("pose:"), "file.yaml:1: pose: must be a map of options");
  EXPECT_EQ(ErrorOf("[1, 2]"), "file.yaml:1: must be a map of options");
  EXPECT_EQ(ErrorOf("name: [a]"), "file.yaml:1: name: must be a string");
}

TEST(YamlReader, EndsWithCheckAndLeavesOptionsAloneWhereItFails) {
  WholeOptions options;
  EXPECT_THROW(ReadYaml(YAML::Load("{name: x, count: 0}"), "file.yaml", options),
               std::invalid_argument);
  EXPECT_EQ(options.name, "left");
  EXPECT_EQ(ErrorOf("count: 0"), "file.yaml: count must be positive");
  EXPECT_EQ(ErrorOf("pose: {scale: 0}"), "file.yaml: scale must not be 0");
  EXPECT_EQ(ErrorOf("layers: [{}, {scale: 0}]"), "file.yaml: scale must not be 0");
  EXPECT_THAT(ErrorOf("pose: {ransac: {max_iterations: 0}}"), testing::HasSubstr("max_iterations"));
}

TEST(YamlReader, NodeMadeInMemoryHasNoLine) {
  YAML::Node node;
  node["count"] = "many";
  WholeOptions options;
  EXPECT_EQ(RefusalOf([&] { ReadYaml(node, "/pose_node", options); }),
            "/pose_node: count: must be an integer, is many");
}

TEST(YamlWriter, WhatIsWrittenReadsBackTheSame) {
  WholeOptions options;
  options.ratio = 1.0 / 3;
  options.name = "a: \"b\"\n";
  options.solver = Solver::kNewton;
  options.layers.resize(2);
  options.layers[1].scale = -HUGE_VAL;
  options.lengths_m = {};
  const std::string text = WriteYaml(options);
  EXPECT_EQ(WriteYaml(Read(text)), text);
  EXPECT_EQ(Read(text).ratio, 1.0 / 3);
  EXPECT_EQ(Read(text).name, options.name);
}

TEST(YamlWriter, NumbersReadAsNumbersForRosparamToo) {
  EXPECT_EQ(FormatYamlNumber(5), "5.0");
  EXPECT_EQ(FormatYamlNumber(1e-5), "1.0e-05");
  EXPECT_EQ(FormatYamlNumber(1.5e300), "1.5e+300");
}

TEST(LoadYamlFile, NamesTheFileAndLine) {
  const std::string path =
      (std::filesystem::temp_directory_path() / "arfm_vo_yaml_reader_test.yaml").string();
  const auto error_of = [&](const std::string& text) {
    std::ofstream(path) << text;
    return RefusalOf([&] { LoadYamlFile(path); });
  };
  EXPECT_THAT(error_of("a: 1\nb: [1, 2\n"), testing::StartsWith(path + ":"));
  EXPECT_EQ(error_of("a: 1\n---\nb: 2\n"), path + ": holds more than one YAML document");
  EXPECT_EQ(error_of(""), "");
  EXPECT_EQ(error_of(",a: 1"), path + ": holds more than one YAML document");  // without end
  std::filesystem::remove(path);
  EXPECT_THROW(LoadYamlFile(path), std::invalid_argument);
}

}  // namespace
}  // namespace arfm_vo
