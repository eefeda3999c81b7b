#pragma once

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <string>

namespace arfm_vo {

/// The same value as YAML. A string becomes a quoted scalar, so that it is never read as a number.
/// Throws std::invalid_argument naming the `key` for what options cannot hold (binary, date).
YAML::Node ToYaml(const XmlRpc::XmlRpcValue& value, const std::string& key);

/// All parameters under `node`'s namespace, without those that libraries read there.
YAML::Node ReadParameterTree(const ros::NodeHandle& node);

}  // namespace arfm_vo
