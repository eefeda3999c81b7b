#pragma once

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <string>

#include "arfm_vo/configuration/yaml_reader.h"

namespace arfm_vo {

/// The same value as YAML. A string becomes a quoted scalar, so that it is never read as a number.
/// Throws std::invalid_argument naming the `key` for what options cannot hold (binary, date).
YAML::Node ToYaml(const XmlRpc::XmlRpcValue& value, const std::string& key);

/// All parameters under `node`'s namespace, without those that libraries read there.
YAML::Node ReadParameterTree(const ros::NodeHandle& node);

/// Reads options from the parameters under `node`'s namespace, strictly: std::invalid_argument
/// names an unknown or mistyped parameter by its full name. What is not set keeps its default.
template <class Options>
Options ReadParameters(const ros::NodeHandle& node) {
  Options options;
  ReadYaml(ReadParameterTree(node), "parameters of " + node.getNamespace(), options);
  return options;
}

}  // namespace arfm_vo
