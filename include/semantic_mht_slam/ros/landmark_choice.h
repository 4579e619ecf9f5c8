#pragma once

#include <vector>

#include <semantic_mht_slam/GetLandmarks.h>
#include <semantic_mht_slam/SemanticMap.h>

namespace semantic_mht_slam {

/// The landmarks of a map that a request of the service `get_landmarks` asks for. Throws InputError for a class that
/// the map's table lacks, and for a center or radius that is not finite or a negative radius.
std::vector<Landmark> chosenLandmarks(const SemanticMap& map, const GetLandmarks::Request& request);

}  // namespace semantic_mht_slam
