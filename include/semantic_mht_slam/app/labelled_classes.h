#pragma once

#include <string>

#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/label_map.h"

namespace semantic_mht_slam {

/// The classes of a segmentation, and what its label ids stand for.
struct LabelledClasses {
  ClassTable classes;
  LabelMap labels;
};

/// Reads the classes of a segmentation from either kind of file; a relative name that is no file here is looked up in
/// the package's configuration folder.
/// - A label map (config/labels_*.yaml): its own labels, with the class table that it names, beside it or shipped.
/// - A class table (config/classes_*.yaml): with the label map of the same name, `labels_X.yaml` for `classes_X.yaml`,
///   beside it or shipped for a shipped table; without one the label ids are those of the table and others are ignored.
/// Throws InputError or ConfigError.
LabelledClasses loadLabelledClasses(const std::string& file);

}  // namespace semantic_mht_slam
