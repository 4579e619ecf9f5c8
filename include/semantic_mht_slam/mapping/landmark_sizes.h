#pragma once

#include <vector>

#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/models/frame.h"

namespace semantic_mht_slam {

/// Gives the landmarks of a submap the mean of the sizes that the detections assigned to them have; `frames` are those
/// of the submap.
void noteSizes(const std::vector<Frame>& frames, Submap& submap);

}  // namespace semantic_mht_slam
