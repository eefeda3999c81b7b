#include "arfm_vo/ros/node/parameters.h"

#include <ros/param.h>

#include <cmath>
#include <string>

#include "arfm_vo/base/check.h"
#include "arfm_vo/base/number_rows.h"
#include "arfm_vo/configuration/yaml_writer.h"

namespace arfm_vo {
namespace {

/// Read from a node's namespace by image_transport and diagnostic_updater.
const char* const kForeignKeys[] = {"image_transport", "diagnostic_period"};

std::string FormatScalar(double value) {
  if (std::isfinite(value)) return FormatNumber(value);  // as an integer where it is one
  return std::isnan(value) ? ".nan" : FormatYamlNumber(value);
}

}  // namespace

YAML::Node ToYaml(const XmlRpc::XmlRpcValue& value, const std::string& key) {
  using XmlRpc::XmlRpcValue;
  XmlRpcValue copy = value;  // its conversions are not const
  YAML::Node node;
  switch (value.getType()) {
    case XmlRpcValue::TypeBoolean:
      return YAML::Node(static_cast<bool>(copy));
    case XmlRpcValue::TypeInt:
      return YAML::Node(static_cast<int>(copy));
    case XmlRpcValue::TypeDouble:
      return YAML::Node(FormatScalar(copy));
    case XmlRpcValue::TypeString:
      node = static_cast<std::string&>(copy);
      node.SetTag("!");  // what yaml-cpp's parser says of a quoted scalar
      return node;
    case XmlRpcValue::TypeArray:
      node = YAML::Node(YAML::NodeType::Sequence);
      for (int i = 0; i < copy.size(); ++i)
        node.push_back(ToYaml(copy[i], key + "[" + std::to_string(i) + "]"));
      return node;
    case XmlRpcValue::TypeStruct:
      node = YAML::Node(YAML::NodeType::Map);
      for (auto& [name, child] : copy) node[name] = ToYaml(child, key + "/" + name);
      return node;
    default:
      throw std::invalid_argument(key +
                                  ": a parameter must be a bool, number, string, list or map");
  }
}

YAML::Node ReadParameterTree(const ros::NodeHandle& node) {
  XmlRpc::XmlRpcValue value;
  const std::string& name = node.getNamespace();
  if (!ros::param::get(name, value)) return YAML::Node(YAML::NodeType::Map);
  Require(value.getType() == XmlRpc::XmlRpcValue::TypeStruct,
          name + ": must be a map of parameters");
  YAML::Node tree = ToYaml(value, name);
  for (const char* key : kForeignKeys) tree.remove(key);
  return tree;
}

}  // namespace arfm_vo
