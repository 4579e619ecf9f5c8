#pragma once

#include <string>

#include "semantic_mht_slam/models/labelled_cloud.h"

namespace semantic_mht_slam {

/// Reads a KITTI scan: little-endian float32 x, y, z, intensity a point. Labels are left empty. Throws InputError
/// naming the file if it is missing or its size is no multiple of 16 bytes.
LabelledCloud readScan(const std::string& scan_path);

/// The same with SemanticKITTI labels: a little-endian uint32 a point, the low 16 bits the class. Throws InputError
/// naming both files and both counts if they do not fit.
LabelledCloud readLabelledScan(const std::string& scan_path, const std::string& labels_path);

}  // namespace semantic_mht_slam
