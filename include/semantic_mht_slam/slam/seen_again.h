#pragma once

#include <cstddef>
#include <vector>

#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/slam/map_graph.h"

namespace semantic_mht_slam {

/// Landmarks that the present pass saw first, each with the one of an earlier pass that stands where it stands: static,
/// of the same class, nearer than `pair_distance_m` on the plane and than their covariances and that of the closure
/// `tie` explain, and no other candidate for either. The present pass may have seen that one, too, from elsewhere;
/// `Identity` keeps apart what a frame shows side by side. A closure pairs only what one keyframe saw; the solution
/// that it leads to shows the others to be the same. The present pass is less than `recent_submaps` submaps around the
/// one that the closure comes from, and what lies before that is earlier.
std::vector<SameLandmark> landmarksSeenAgain(const Map& map, const MapGraph& graph, const ClassTable& classes,
                                             const LoopClosureRecord& tie, std::size_t recent_submaps,
                                             double pair_distance_m);

/// The last closure of the newest submap that passed the checks of its search, if it holds; else none.
ClosureId newestTie(const Map& map);

}  // namespace semantic_mht_slam
