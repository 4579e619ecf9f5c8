#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/graph/batch_graph.h"

namespace semantic_mht_slam {

/// How a whole graph is optimised at once.
struct BatchOptions {
  /// Cauchy loss on loop closures and points (none on odometry, which joins a pose to the next).
  bool cauchy = false;
  double cauchy_scale = 1.0;  ///< whitened error where the loss begins to flatten, > 0

  /// Leave out loop closures that contradict the largest set of mutually consistent ones.
  bool reject_inconsistent_loops = false;
  /// Odometry covariances are multiplied by this in the consistency test, >= 1.
  double odometry_cov_scale = 2.0;

  /// Start from the relaxed linear solution where it costs less than the estimates given (`chordalGuess`).
  bool try_chordal_guess = true;
  int max_iterations = 100;
};

/// A loop closure that was left out of the final optimisation.
struct RejectedLoop {
  int edge = 0;                 ///< index into `pose_edges`
  double mahalanobis_sq = 0.0;  ///< e^T Omega e at the result
};

/// What `optimizeBatch` did.
struct BatchReport {
  /// Empty: success. Otherwise the reason, and the graph holds the estimates it came with.
  std::string failure;
  double initial_cost = 0.0;   ///< F of the estimates given, missing ones filled in from odometry
  double start_cost = 0.0;     ///< F where the iterations began
  double final_cost = 0.0;     ///< F of the result over all edges, without robust loss, rejected loops included
  double accepted_cost = 0.0;  ///< the same without the rejected loops
  bool started_from_chordal_guess = false;
  int iterations = 0;
  bool converged = false;
  std::vector<RejectedLoop> rejected_loops;
};

/// Minimises F (see `BatchGraph`) over all poses and points; held poses, or the first one, do not move. The result does
/// not depend on threads or time. Graphs with a defect (`findDefect`), singular ones and failed or non-finite solutions
/// are refused: `failure` says why, the estimates stay what they were.
/// Throws std::invalid_argument for options out of range.
template <int kDim>
BatchReport optimizeBatch(BatchGraph<kDim>& graph, const BatchOptions& options = {});

}  // namespace semantic_mht_slam
