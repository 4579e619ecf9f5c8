#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <geometry_msgs/Point.h>

#include <semantic_mht_slam/SemanticMap.h>

namespace semantic_mht_slam {

/// The landmark of a map that is nearest to a point, seen from above, as a click from above has no height; nullptr if
/// none is within `limit_m`. The result lives in `map`.
const Landmark* nearestLandmark(const SemanticMap& map, const geometry_msgs::Point& point, double limit_m);

/// Name of the class with a number in the class table of a map.
std::string nameOfClass(const SemanticMap& map, std::uint16_t id);

/// What is known of a landmark, a line each: name and existence, classes, history, and each alternative of its place.
std::vector<std::string> describeLandmark(const SemanticMap& map, const Landmark& landmark);

}  // namespace semantic_mht_slam
