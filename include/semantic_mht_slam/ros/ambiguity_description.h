#pragma once

#include <string>
#include <vector>

#include <semantic_mht_slam/AmbiguousDetections.h>
#include <semantic_mht_slam/SemanticMap.h>

#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/mapping/unsure_detections.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Detections of a finished submap of `map` as a message: where they are in the map now, landmarks by their ids in it.
AmbiguousDetections toAmbiguousDetections(const UnsureDetections& unsure, const Map& map, const ClassTable& classes,
                                          const std::string& map_frame);

/// Headings of the cells below.
std::vector<std::string> ambiguityColumns();

/// An ambiguous detection in words: what it was given to, with what probability.
std::vector<std::string> describeDetection(const SemanticMap& map, const AmbiguousDetection& detection);

/// The same of one of its alternatives: what, probability, distance, and what speaks for it.
std::vector<std::string> describeAlternative(const AmbiguousDetection& detection,
                                             const DetectionAlternative& alternative);

/// How many there are, and how many of them the message has.
std::string summaryOf(const AmbiguousDetections& message);

}  // namespace semantic_mht_slam
