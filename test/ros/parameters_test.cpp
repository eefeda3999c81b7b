#include "arfm_vo/ros/parameters.h"

#include <gtest/gtest.h>

#include <cmath>

#include "ros/expect_throw.h"

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

}  // namespace
}  // namespace arfm_vo
