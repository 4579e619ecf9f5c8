#pragma once

#include <vector>

#include "semantic_mht_slam/graph/batch_graph.h"

namespace semantic_mht_slam {

/// Which loop closures of a graph belong together.
struct LoopConsistency {
  std::vector<int> consistent;    ///< indices into `pose_edges`: the largest set in which every two agree
  std::vector<int> inconsistent;  ///< loop closures outside that set
};

/// Pairwise consistency maximisation (Mangelson et al., Pairwise consistent measurement set maximization for robust
/// multi-robot map merging, ICRA 2018): two loop closures agree if the cycle through both and the odometry between
/// their ends comes back to where it started, within the quantile `gate` (Mahalanobis distance squared) under the
/// covariances of all four links. A loop closure that contradicts odometry alone by more than `gate` is out.
///
/// `odometry_cov_scale` multiplies the covariances of odometry, which public files and real sensors state too small
/// for long stretches because errors of successive steps are not independent.
///
/// Loop closures whose ends no chain of odometry edges joins cannot be tested; they are returned as consistent.
template <int kDim>
LoopConsistency findConsistentLoops(const BatchGraph<kDim>& graph, double gate, double odometry_cov_scale);

}  // namespace semantic_mht_slam
