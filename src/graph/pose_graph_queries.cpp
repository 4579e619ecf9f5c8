#include "marginals.h"
#include "pose_graph_checks.h"
#include "pose_graph_impl.h"

// What a graph says of itself.
namespace semantic_mht_slam {

std::size_t PoseGraph::positions() const {
  return impl_->graph_.outer.factors.size();
}
std::optional<Pose> PoseGraph::T_outer_world() const {
  return impl_->graph_.outer.T_outer_world();
}
PoseNode PoseGraph::node(int index) const {
  return impl_->graph_.node(index);
}
int PoseGraph::nodes() const {
  return impl_->graph_.nodeCount();
}

std::vector<Pose> PoseGraph::poses() const {
  std::vector<Pose> result;
  for (const NodeState& node : impl_->graph_.nodes) result.push_back(node.pose());
  return result;
}

Pose PoseGraph::pose(int node) const {
  require(node >= 0 && node < nodes(), "there is no such node");
  return impl_->graph_.nodes[node].pose();
}

std::optional<Eigen::Vector3d> PoseGraph::landmark(std::int64_t id) const {
  const auto found = impl_->graph_.landmarks.find(impl_->graph_.keptNumber(id));
  if (found == impl_->graph_.landmarks.end()) return std::nullopt;
  return impl_->graph_.landmarkInWorld(found->second);
}

std::vector<LoopDecision> PoseGraph::loopDecisions() const {
  std::vector<LoopDecision> result;
  for (int i = 0; i < impl_->graph_.loopCount(); ++i) result.push_back(impl_->decision(i));
  return result;
}

double PoseGraph::cost() const {
  return nodes() == 0 ? 0.0 : impl_->whole(impl_->graph_).cost();
}

std::optional<GraphMarginals> PoseGraph::marginals() const {
  return marginalsOf(impl_->graph_, impl_->config());
}
std::optional<std::vector<NodeMarginal>> PoseGraph::coarseMarginals() const {
  return impl_->coarseMarginals();
}
std::int64_t PoseGraph::keptNumber(std::int64_t id) const {
  return impl_->graph_.keptNumber(id);
}

}  // namespace semantic_mht_slam
