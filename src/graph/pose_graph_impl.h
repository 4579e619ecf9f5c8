#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/graph/pose_graph.h"

#include "deadline.h"
#include "graph_archive.h"
#include "graph_state.h"
#include "hierarchy.h"
#include "loop_review.h"
#include "subgraph.h"

namespace semantic_mht_slam {

class PoseGraph::Impl {
 public:
  explicit Impl(const PoseGraphConfig& config) : config_(config), review_(config_), hierarchy_(config_) {}

  int addNode(const PoseNode& node);
  int addLoopClosure(const LoopConstraint& loop);
  void removeLoopClosure(int loop);
  void addPrior(int node, const Pose& T_world_node, const PoseCov& cov);
  void addPosition(const OuterPosition& position);
  void regroup(std::vector<std::vector<std::int64_t>> groups);
  std::vector<LoopDecision> decide();
  PoseGraphUpdate optimize();
  PoseGraphUpdate optimizeFully();
  Subgraph whole(GraphState& graph) const { return {graph, range(0, graph.nodeCount()), Surroundings::kHeld, config_}; }
  std::optional<std::vector<NodeMarginal>> coarseMarginals() const { return hierarchy_.marginals(graph_); }
  const PoseGraphConfig& config() const { return config_; }
  LoopDecision decision(int loop) const;
  void transfer(StateArchive& archive, const std::vector<PoseNode>& expected);
  void transferPositions(StateArchive& archive);

  mutable GraphState graph_;  // lent to Ceres, whose interface takes mutable addresses also for evaluation

 private:
  void alignOuter();
  bool solveGlobally(const Deadline& deadline, PoseGraphUpdate& update);
  void closeLoops(const Deadline& deadline, PoseGraphUpdate& update);
  bool solveWindow(const std::vector<int>& nodes, int iterations, double max_seconds, PoseGraphUpdate& update);
  std::vector<LoopDecision> takeChanges();

  PoseGraphConfig config_;
  LoopReview review_;
  Hierarchy hierarchy_;
  int in_hierarchy_ = 0;
  std::vector<std::optional<LoopState>> reported_;
  std::vector<OdometryStep> odometry_;
};

}  // namespace semantic_mht_slam
