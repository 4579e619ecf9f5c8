#pragma once

#include <memory>
#include <vector>

#include "semantic_mht_slam/graph/pose_graph.h"
#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

/// All that is known of a finished submap but what the estimator goes on with: a copy, for whoever describes it to
/// others while that goes on (see `deltaOf`).
struct SubmapContent {
  std::shared_ptr<const Submap> submap;
  std::vector<Keyframe> keyframes;
  std::vector<PoseNode> nodes;  ///< of the keyframes
  Pose T_before_first;          ///< odometry from the keyframe before; without one, where the odometry begins
  bool begins_session = false;  ///< no odometry leads here, but a pose that was found in the map
  OdometryModel odometry;
  std::vector<LoopClosureRecord> closures;  ///< verified ones that came with it
};

/// All of a map, as far as it is finished.
struct MapContent {
  double range_factor = 1.0;
  std::vector<SubmapContent> submaps;
  std::vector<bool> held;  ///< of all their closures whether it holds
};

}  // namespace semantic_mht_slam
