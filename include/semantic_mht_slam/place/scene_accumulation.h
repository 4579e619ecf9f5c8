#pragma once

#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

/// The scene of one frame's detections. A detection without covariance has that of its class: along the line of sight
/// and across it. Throws std::invalid_argument for a class that the table lacks.
Scene sceneOfFrame(const Detections& detections, const ClassTable& classes);

/// The scene of several frames: `T_base_frame` brings each into one base frame. Detections of one class that lie on
/// each other become one object; what was seen once in a long stretch is left out, as clutter and moving objects are.
/// Throws std::invalid_argument for lists of different lengths and as `sceneOfFrame` does.
Scene accumulateScene(const std::vector<Detections>& frames, const std::vector<Pose>& T_base_frame,
                      const ClassTable& classes, double min_merge_radius_m = 0.8);

}  // namespace semantic_mht_slam
