#pragma once

#include <string>

#include <yaml-cpp/yaml.h>

namespace semantic_mht_slam {

/// "file:line" of a node.
std::string originOf(const std::string& path, const YAML::Node& node);

/// The one document of a YAML file; a null node for an empty file. Throws InputError naming file and line.
YAML::Node loadYaml(const std::string& path);

}  // namespace semantic_mht_slam
