#pragma once

#include <string>

#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/label_map.h"

namespace semantic_mht_slam {

/// True if a YAML file is a label map rather than a class table: a map with the key `labels`. Throws InputError for a
/// file that is missing or no YAML.
bool isLabelMap(const std::string& path);

/// The key `class_table` of a label map: the file of the class table whose names the map uses. Throws InputError.
std::string classTableOfLabelMap(const std::string& path);

/// Reads a label map: the keys `class_table` (a file), `labels` and optionally `moving` (maps of raw id to class name;
/// things with a moving label are known to move) and `ignored` (list of raw ids that are no objects).
/// Throws InputError or ConfigError naming file, line and key: unknown keys, ids that are no number in [0, 65535] or
/// stand twice, names that the table lacks.
LabelMap readLabelMap(const std::string& path, const ClassTable& classes);

}  // namespace semantic_mht_slam
