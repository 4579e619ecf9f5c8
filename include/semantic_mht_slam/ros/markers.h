#pragma once

#include <string>
#include <vector>

#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <semantic_mht_slam/SemanticMap.h>

#include "semantic_mht_slam/app/live_config.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/frame.h"
#include "semantic_mht_slam/perception/extracted_object.h"

namespace semantic_mht_slam {

/// Size of a symbol of a map, m: as large as the detector's range is by the reference's, where it is a metre; larger in
/// a large map.
double symbolSize(double range_factor, const SemanticMap& map);

/// The objects of a frame as boxes in class colours, in the map frame: their extents where they are known, else a size
/// by class, of a few times `symbol_m`; and the vehicle, an arrow. One marker namespace a class, and `base`; the
/// first marker clears what was shown before.
visualization_msgs::MarkerArray toObjectMarkers(const Frame& frame, const Pose& T_map_odom, const ClassTable& classes,
                                                double symbol_m, const std::string& map_frame);

/// The landmarks of a map: an ellipsoid in the class colour for each component of the mixture, as opaque as its weight
/// is high and the landmark not provisional, two `symbol_m` wide at least; yellow lines from the mean of an undecided
/// landmark to its components; labels if `live` asks for them. One namespace a class, and `undecided` and `labels`; the
/// first marker clears what was shown before.
visualization_msgs::MarkerArray toLandmarkMarkers(const SemanticMap& map, const ClassTable& classes, double symbol_m,
                                                  const LiveConfig& live);

/// Extracted objects as the boxes of their points in class colours, in the frame of the scan. One marker namespace a
/// class; the first marker clears what was shown before.
visualization_msgs::MarkerArray toBoxMarkers(const std::vector<ExtractedObject>& objects, const ClassTable& classes,
                                             const std_msgs::Header& header);

}  // namespace semantic_mht_slam
