#pragma once

#include <map>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/models/dead_reckoning.h"
#include "semantic_mht_slam/slam/map_graph.h"

namespace semantic_mht_slam {

/// How far keyframes and landmarks of a map may be off, the drive's first pose being where the map begins. Unknown is
/// said as that (see `unknownPoseCov`).
struct MapUncertainty {
  IdVector<KeyframeId, FixedAxesCov> keyframes;     ///< axes of the map
  std::map<LandmarkId, Eigen::Matrix3d> landmarks;  ///< axes of the map, m^2; by the pose graph's name
};

/// Covariance at the first pose, which is where the map begins: the least that is ever said.
FixedAxesCov gaugeCov();

/// What the pose graph cannot know of itself.
struct MapGauge {
  FixedAxesCov start_cov = gaugeCov();  ///< of the first keyframe
  double scale_stddev = 0.0;            ///< relative, of all lengths: odometry and detector may both be off
};

/// By the whole pose graph, in time that grows with it.
MapUncertainty uncertaintyOf(const Map& map, const MapGraph& graph, const MapGauge& gauge);

/// Nearly the same of keyframes alone, in time for every submap.
MapUncertainty coarseUncertaintyOf(const Map& map, const MapGraph& graph, const MapGauge& gauge);

/// The newest keyframe; of unknown covariance if the graph cannot say it.
UncertainPose newestKeyframe(const Map& map, const MapGraph& graph, const MapGauge& gauge);

}  // namespace semantic_mht_slam
