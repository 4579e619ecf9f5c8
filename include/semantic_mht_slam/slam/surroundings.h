#pragma once

#include <cstddef>
#include <vector>

#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/mapping/earlier_map.h"
#include "semantic_mht_slam/slam/map_graph.h"
#include "semantic_mht_slam/slam/map_uncertainty.h"

namespace semantic_mht_slam {

/// Adds to a landmark what is not known of the pose (axes of the map) that it hangs on, `lever_m` from it, and a
/// deviation that more detections do not lower.
void addPoseShare(const FixedAxesCov& pose_cov, const Eigen::Vector3d& lever_m, double floor_m,
                  MixtureLandmark& landmark);

/// A landmark of a submap in the map frame; those of the pose graph stand where the graph has them, if they are not
/// locked.
MixtureLandmark inMap(const Map& map, const MapGraph& graph, SubmapId submap, const MixtureLandmark& seen);

/// The landmarks of a map at their corrected places, map frame, by rising id; their covariances hold what is not known
/// of the pose that they were seen from.
std::vector<MixtureLandmark> landmarksOf(const Map& map, const MapGraph& graph, const MapUncertainty& uncertainty);

/// Of the landmarks seen in a submap that is not finished, those that would be new to the map; map frame.
std::vector<MixtureLandmark> landmarksBeyond(const Map& map, const std::vector<MixtureLandmark>& seen,
                                             const Pose& T_map_submap);

/// What earlier passes know of the surroundings of a submap that begins where `prior` says; what was seen in the newest
/// `recent_submaps` submaps is of the present pass. Landmarks are of use within `reach_m`.
EarlierMap earlierMapAround(const RegistrationPrior& prior, const Map& map, const MapGraph& graph,
                            std::size_t recent_submaps, double reach_m);

/// True if a closure ties the newest submap to an earlier pass, and every place of it was passed at least `passes`
/// times within `radius_m`; false for 0.
bool isPlaceKnown(const Map& map, std::size_t passes, double radius_m);

}  // namespace semantic_mht_slam
