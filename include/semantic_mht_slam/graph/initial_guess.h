#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/graph/batch_graph.h"

namespace semantic_mht_slam {

/// Why no estimate can be computed: an edge with a missing end, no pose at all, poses that no chain of edges joins to a
/// held one, or a number that is not finite. Empty if there is nothing to object to.
template <int kDim>
std::optional<std::string> findDefect(const BatchGraph<kDim>& graph);

/// Gives every pose and point that has no estimate one: odometry (edges to the next pose) first, then other edges,
/// breadth first from the held poses and those that have an estimate. The graph must have no defect.
template <int kDim>
void fillMissingEstimates(BatchGraph<kDim>& graph);

/// Poses from two linear least-squares problems, without any guess: first the rotations, relaxed to matrices and
/// projected back ("chordal", Carlone et al., Initialization techniques for 3D SLAM, ICRA 2015, section III-B), then
/// the translations under these rotations. The first held pose keeps its place. Points are not moved.
/// Empty if one of the linear systems is singular.
template <int kDim>
std::optional<std::vector<typename BatchGraph<kDim>::PoseType>> chordalGuess(const BatchGraph<kDim>& graph);

/// F of the estimates in `graph` (see `BatchGraph`).
template <int kDim>
double cost(const BatchGraph<kDim>& graph);

}  // namespace semantic_mht_slam
