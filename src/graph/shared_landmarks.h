#pragma once

#include <optional>

#include "graph_state.h"

namespace semantic_mht_slam {

/// What landmarks that were first seen long ago say about the pose of a node that saw them again: a relative pose to
/// the first node of the chunk that most of them come from. The skeleton, which has no landmarks, needs it.
/// Empty if fewer than five of them agree, or if they lie on a line.
std::optional<LoopConstraint> relateThroughLandmarks(const GraphState& graph, int node, const PoseGraphConfig& config);

}  // namespace semantic_mht_slam
