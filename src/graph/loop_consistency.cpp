#include "semantic_mht_slam/graph/loop_consistency.h"

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/max_clique.h"

#include "odometry_chain.h"

namespace semantic_mht_slam {
namespace {

template <int kDim>
OdometryChain<kDim> odometryOf(const BatchGraph<kDim>& graph, double cov_scale) {
  std::vector<const typename BatchGraph<kDim>::PoseEdge*> step(graph.poses.size(), nullptr);
  for (const auto& edge : graph.pose_edges) {
    if (isOdometry(edge) && step[edge.to] == nullptr) step[edge.to] = &edge;
  }
  OdometryChain<kDim> chain;
  for (const auto* edge : step) {
    if (edge == nullptr) {
      chain.startSegment();
    } else {
      chain.append(edge->T_from_to, cov_scale * inverted(edge->information));
    }
  }
  return chain;
}

template <int kDim>
std::vector<int> largestAgreeingSet(const OdometryChain<kDim>& odometry, const std::vector<TestedLoop<kDim>>& loops,
                                    double gate) {
  BitGraph agreement(static_cast<int>(loops.size()));
  for (int a = 0; a < agreement.size(); ++a) {
    for (int b = a + 1; b < agreement.size(); ++b) {
      if (!odometry.joins(loops[a].from, loops[b].from)) continue;
      if (gapBetween(odometry, loops[a], loops[b]) <= gate) agreement.join(a, b);
    }
  }
  return maximumClique(agreement);
}

}  // namespace

template <int kDim>
LoopConsistency findConsistentLoops(const BatchGraph<kDim>& graph, double gate, double odometry_cov_scale) {
  const OdometryChain<kDim> odometry = odometryOf(graph, odometry_cov_scale);
  LoopConsistency result;
  std::vector<TestedLoop<kDim>> loops;
  std::vector<int> edges;
  for (int i = 0; i < graph.edgeCount(); ++i) {
    const auto& edge = graph.pose_edges[i];
    if (isOdometry(edge)) continue;
    if (!odometry.joins(edge.from, edge.to)) {
      result.consistent.push_back(i);
      continue;
    }
    const auto loop = makeTestedLoop<kDim>(edge.from, edge.to, edge.T_from_to, inverted(edge.information));
    if (gapToOdometry(odometry, loop) <= gate) {
      loops.push_back(loop);
      edges.push_back(i);
    } else {
      result.inconsistent.push_back(i);
    }
  }
  std::vector<bool> chosen(loops.size(), false);
  for (const int node : largestAgreeingSet(odometry, loops, gate)) chosen[node] = true;
  for (std::size_t i = 0; i < loops.size(); ++i) {
    (chosen[i] ? result.consistent : result.inconsistent).push_back(edges[i]);
  }
  return result;
}

template LoopConsistency findConsistentLoops<2>(const BatchGraph<2>&, double, double);
template LoopConsistency findConsistentLoops<3>(const BatchGraph<3>&, double, double);

}  // namespace semantic_mht_slam
