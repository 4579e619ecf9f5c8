#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantic_mht_slam/evaluation/landmark_error.h"

namespace semantic_mht_slam {

/// Landmarks with the number that their file gives them, or their place in the file.
struct NumberedLandmarks {
  std::vector<std::int64_t> ids;
  std::vector<PointLandmark> landmarks;
};

/// Landmarks of the classes named, or of all if none is; those of unknown class always stay. The file is a CSV with
/// columns x,y and optionally z,class,id or landmark, or rows x,y[,z] without a header, metres. Throws InputError that
/// names file, line and column.
NumberedLandmarks readLandmarks(const std::string& path, const std::vector<std::string>& classes);

}  // namespace semantic_mht_slam
