#include "arfm_vo/ros/node/parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/fields.h"
#include "base/refusal.h"

namespace arfm_vo {
namespace {

using XmlRpc::XmlRpcValue;

TEST(Parameters, ScalarsKeepTheirTypeAndValue) {
  EXPECT_TRUE(ToYaml(XmlRpcValue(true), "p").as<bool>());
  EXPECT_EQ(ToYaml(XmlRpcValue(-7), "p").as<int>(), -7);
  EXPECT_EQ(ToYaml(XmlRpcValue(0.1), "p").as<double>(), 0.1);
  EXPECT_EQ(ToYaml(XmlRpcValue(1e-5), "p").as<double>(), 1e-5);
  EXPECT_TRUE(std::isnan(ToYaml(XmlRpcValue(double(NAN)), "p").as<double>()));
  EXPECT_EQ(ToYaml(XmlRpcValue(-double(INFINITY)), "p").as<double>(), -INFINITY);
}

TEST(Parameters, AStringIsQuotedSoThatItIsNoNumber) {
  const YAML::Node node = ToYaml(XmlRpcValue("0.5"), "p");
  EXPECT_EQ(node.as<std::string>(), "0.5");
  EXPECT_EQ(node.Tag(), "!");
  EXPECT_NE(ToYaml(XmlRpcValue(0.5), "p").Tag(), "!");
}

TEST(Parameters, ListsAndMapsNest) {
  XmlRpcValue value;
  value["window"]["size"] = 5;
  value["window"]["weights"][0] = 1.5;
  value["window"]["weights"][1] = 2.5;
  const YAML::Node node = ToYaml(value, "p");
  EXPECT_EQ(node["window"]["size"].as<int>(), 5);
  EXPECT_EQ(node["window"]["weights"].as<std::vector<double>>(), (std::vector<double>{1.5, 2.5}));
}

TEST(Parameters, BinaryIsRefusedWithItsFullName) {
  char bytes[] = "xy";
  XmlRpcValue value;
  value["window"]["weights"][0] = XmlRpcValue(bytes, 2);
  EXPECT_INVALID(ToYaml(value, "/pose_node"), "/pose_node/window/weights[0]");
}

struct HeadOptions {
  double max_slew_rate_dps = 5;
  bool is_gated = true;
  void Check() const { Require(max_slew_rate_dps > 0, "max_slew_rate_dps must be positive"); }
  ARFM_FIELDS(max_slew_rate_dps, is_gated)
};

struct Options {
  HeadOptions head;
  std::string base_frame = "base_link";
  void Check() const { Require(!base_frame.empty(), "base_frame must not be empty"); }
  ARFM_FIELDS(head, base_frame)
};

Options Read(const XmlRpcValue& value) {
  Options options;
  ReadYaml(ToYaml(value, "/pose_node"), "parameters of /pose_node", options);
  return options;
}

TEST(Parameters, FillOptionsAnIntegerWillDoForADouble) {
  XmlRpcValue value;
  value["head"]["max_slew_rate_dps"] = 3;
  value["base_frame"] = "rover";
  const Options options = Read(value);
  EXPECT_EQ(options.head.max_slew_rate_dps, 3);
  EXPECT_TRUE(options.head.is_gated);
  EXPECT_EQ(options.base_frame, "rover");
}

TEST(Parameters, AnUnknownOrMistypedOneIsRefusedWithItsFullName) {
  XmlRpcValue unknown;
  unknown["head"]["max_slew_rate"] = 3.0;
  EXPECT_INVALID(Read(unknown), "parameters of /pose_node: head.max_slew_rate");
  XmlRpcValue mistyped;
  mistyped["head"]["max_slew_rate_dps"] = "3.0";
  EXPECT_INVALID(Read(mistyped), "head.max_slew_rate_dps");
  XmlRpcValue wrong;
  wrong["base_frame"] = "";
  EXPECT_INVALID(Read(wrong), "base_frame must not be empty");
  wrong["base_frame"] = "rover";
  wrong["head"]["max_slew_rate_dps"] = 0;
  EXPECT_INVALID(Read(wrong), "max_slew_rate_dps must be positive");
}

}  // namespace
}  // namespace arfm_vo
