#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Reads a YAML file of nested maps as settings: keys joined by dots, origin "file:line".
/// Throws InputError for a missing file, broken YAML and anything that is not a map of scalars, and ConfigError for
/// keys that stand twice.
std::vector<Setting> readSettings(const std::string& path);

/// Reads a class table: a map with the one key `classes`, a list of maps with the keys of `ClassInfo`.
/// Throws ConfigError with all problems.
ClassTable readClassTable(const std::string& path);

}  // namespace semantic_mht_slam
