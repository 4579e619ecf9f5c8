#include "semantic_mht_slam/graph/pose_graph.h"

namespace semantic_mht_slam {

void describe(PoseGraphConfig& config, Fields& fields) {
  fields.add("loop_cauchy_scale", config.loop_cauchy_scale, "", {1e-3, 1e3},
             "Whitened error of a loop closure where its Cauchy loss begins to flatten.");
  fields.add("landmark_cauchy_scale", config.landmark_cauchy_scale, "", {1e-3, 1e3},
             "Whitened error of a landmark sighting where its Cauchy loss begins to flatten.");
  fields.add("window_nodes", config.window_nodes, "", {1, 1000},
             "Newest nodes (keyframes) that every call optimises in full.");
  fields.add("chunk_nodes", config.chunk_nodes, "", {2, 1000},
             "Nodes to a hub of the skeleton that loop closures are solved on.");
  fields.add("window_iterations", config.window_iterations, "", {1, 100},
             "Iterations of the newest nodes in one call.");
  fields.add("global_iterations", config.global_iterations, "", {1, 100},
             "Iterations of the skeleton in one call; what is left is done in the next.");
  fields.add("repair_interval", config.repair_interval, "", {0, 1000},
             "Every so many nodes a piece of the drive that loop closures bent is optimised in full; 0: never.");
  fields.add("whole_nodes", config.whole_nodes, "", {0, 1000000},
             "Graphs up to this size are optimised as a whole when a loop closes.");
  fields.add("time_budget_s", config.time_budget_s, "s", {0.0, 1e6},
             "Wall clock limit of one call, 0 for none; results depend on the machine when it is reached.");
  fields.add("loop_gate", config.loop_gate, "", {1e-3, 1e6},
             "Mahalanobis distance squared up to which loop closures agree with odometry and each other (6 numbers).");
  fields.add("odometry_cov_scale", config.odometry_cov_scale, "", {1.0, 1e3},
             "Factor on odometry covariances when loop closures are compared; successive errors are not independent.");
  fields.add("compared_loops", config.compared_loops, "", {1, 10000},
             "Newest loop closures that are tested for agreement with each other.");
}

}  // namespace semantic_mht_slam
