#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "semantic_mht_slam/evaluation/association_score.h"
#include "semantic_mht_slam/evaluation/loop_score.h"

namespace semantic_mht_slam {

/// Loop closures of a CSV query_frame,match_frame,accepted,tx,ty,tz and further columns, which are not looked at.
/// Throws InputError.
std::vector<ClosureEstimate> readClosures(const std::string& path);

/// Truth of detections, CSV frame,landmark. Throws InputError.
std::vector<TrueDetection> readTrueDetections(const std::string& path);

/// Associations of detections, CSV frame,row,landmark. Throws InputError.
std::vector<AssociatedDetection> readAssociations(const std::string& path);

}  // namespace semantic_mht_slam
