#pragma once

#include <vector>

#include "semantic_mht_slam/merging/map_merger.h"

namespace semantic_mht_slam {

/// Says of each pair whether it is joined, how likely that is and why, and of each island why it is one.
void describe(const std::vector<MergeMap>& maps, MergeResult& result);

}  // namespace semantic_mht_slam
