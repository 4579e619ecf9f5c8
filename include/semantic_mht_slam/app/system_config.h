#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/live_config.h"
#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// What the node does with the map from its start on.
enum class StartMode { kMapping, kLocalization };

/// What only the ROS node uses.
struct NodeConfig {
  std::string map_frame = "map";
  std::string odom_frame = "odom";
  std::string base_frame = "base_link";
  int queue_size = 2000;
  double max_delay_s = 10.0;
  double tf_timeout_s = 2.0;
  double trajectory_period_s = 0.5;
  int trajectory_poses = 20000;
  double ambiguous_below_prob = 0.98;
  int ambiguous_most = 100;
  double reset_after_jump_back_s = 1.0;
  bool publishes_tf = true;
  std::string map;         ///< a map file; empty: none
  std::string map_folder;  ///< outside of which no map is read or written; empty: anywhere
  StartMode mode = StartMode::kMapping;
  LiveConfig live;
};

void describe(NodeConfig& config, Fields& fields);

/// Throws ConfigError unless the three frames have names that tf takes and that differ.
void requireUsableFrames(const NodeConfig& config);

/// Every parameter of the system: one description for the YAML file, the ROS parameters and `--set`.
struct SystemConfig {
  std::string class_table = "classes_semantic_kitti.yaml";
  SlamConfig slam;
  NodeConfig node;
};

void describe(SystemConfig& config, Fields& fields);

/// Defaults, changed by a YAML file and then by further settings, whose relative paths are those of the folder that one
/// stands in if there is such a file. Throws InputError or ConfigError.
SystemConfig loadSystemConfig(const std::string& yaml_path, const std::vector<Setting>& overrides);

/// Defaults changed by settings alone. Throws ConfigError.
SystemConfig makeSystemConfig(const std::vector<Setting>& settings);

/// The effective configuration as YAML.
std::string toYaml(SystemConfig config);

/// docs/parameters.md: every parameter of the system, of a class table's entries and of a scenario.
std::string parameterReference();

/// "key=value" of a command line. Throws InputError without '='.
Setting parseOverride(const std::string& text);

/// Reads `config.class_table`; a relative path is looked up in `folder` (that of the YAML file), then in the package's
/// own configuration folder.
ClassTable loadClassTable(const SystemConfig& config, const std::string& folder);

/// The class table's file by the same rule: as it stands if it is the package's own, else absolute, so that the
/// effective configuration can be read back from another folder.
std::string locateClassTable(const SystemConfig& config, const std::string& folder);

/// The submap evaluator's tree by the same rule.
std::string locateEvaluatorTree(const SystemConfig& config, const std::string& folder);

/// The configuration of the estimator with the path of the submap evaluator's tree as it can be opened from anywhere.
/// Throws InputError if that tree is needed and cannot be used.
SlamConfig loadableSlamConfig(const SystemConfig& config, const std::string& folder);

/// A file of the package's configuration folder: beside an installed program, else in the source tree.
std::string packageConfigFile(const std::string& name);

}  // namespace semantic_mht_slam
