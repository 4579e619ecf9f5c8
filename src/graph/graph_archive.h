#pragma once

#include <vector>

#include "semantic_mht_slam/common/state_archive.h"

#include "graph_state.h"
#include "loop_review.h"

namespace semantic_mht_slam {

/// Odometry as it was added, to begin the sums over it again.
struct OdometryStep {
  Pose T_previous_node;
  PoseCov cov;
};

/// Everything that was added to a graph, with the estimate and what was decided of loop closures; of odometry that is
/// as `expected` only that. Throws InputError if it was written with other sizes of windows or chunks.
void transferGraph(StateArchive& archive, const PoseGraphConfig& config, const std::vector<PoseNode>& expected,
                   std::vector<OdometryStep>& odometry, GraphState& graph, LoopReview& review);

}  // namespace semantic_mht_slam
