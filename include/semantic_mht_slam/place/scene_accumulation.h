#pragma once

#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

/// The scene of one frame's detections. A detection without covariance has that of its class: along the line of sight
/// and across it. Throws std::invalid_argument for a class that the table lacks.
Scene sceneOfFrame(const Detections& detections, const ClassTable& classes);

/// A frame, seen from a base frame that is another one's.
struct SeenFrame {
  Detections detections;
  Pose T_base_frame;
  MotionVariance drift;  ///< of the odometry between the two
};

/// The scene of several frames in their base frame. A frame shows as many objects as it has detections: each is given
/// to another object of its class, or begins one. What lies on each other and was never seen together becomes one
/// object, of the class that it was seen as more often. What was seen once in a long stretch is left out, as clutter
/// and moving objects are. Throws std::invalid_argument as `sceneOfFrame` does.
Scene accumulateScene(const std::vector<SeenFrame>& frames, const ClassTable& classes, double min_merge_radius_m = 0.8);

}  // namespace semantic_mht_slam
