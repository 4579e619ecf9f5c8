#include "semantic_mht_slam/graph/pose_graph.h"

#include <algorithm>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/state_archive.h"

#include "outer_alignment.h"
#include "pose_graph_checks.h"
#include "pose_graph_impl.h"

namespace semantic_mht_slam {
namespace {

constexpr int kFullIterations = 50;
constexpr double kFullTolerance = 1e-6;  // of the cost; what is left of the poses is a few centimetres
constexpr int kRepairIterations = 1;     // an interpolated piece is so near its optimum that one step reaches it
constexpr double kWindowShare = 0.5;     // of a time budget, so that loop closures get the rest

}  // namespace

int PoseGraph::Impl::addNode(const PoseNode& node) {
  const int index = graph_.nodeCount();
  check(node, index == 0);
  NodeState& state = graph_.nodes.emplace_back();
  const Pose before = index == 0 ? Pose::identity() : graph_.nodes[index - 1].pose();
  writeBlock(node.T_world_node.value_or(before * node.T_previous_node), state.block.data());
  if (index > 0) {
    state.odometry_cost = std::make_unique<RelativePose3Cost>(node.T_previous_node, inverted(node.odometry_cov));
    state.shared_errors = node.shared_errors;
  }
  for (const LandmarkSighting& sighting : node.sightings) graph_.addSighting(sighting);
  odometry_.push_back({node.T_previous_node, node.odometry_cov});
  review_.extendOdometry(node.T_previous_node, node.odometry_cov, index == 0);
  return index;
}

int PoseGraph::Impl::addLoopClosure(const LoopConstraint& loop) {
  const int count = graph_.nodeCount();
  require(loop.from >= 0 && loop.from < count && loop.to >= 0 && loop.to < count && loop.from != loop.to,
          "a loop closure joins two different nodes that exist");
  require(loop.T_from_to.isValid(), "a loop closure is not a finite pose");
  require(isCovariance6(loop.cov), "a loop closure's covariance is not positive definite");
  graph_.addLoop(loop);
  review_.add(graph_, loop);
  return graph_.loopCount() - 1;
}

void PoseGraph::Impl::removeLoopClosure(int loop) {
  require(loop >= 0 && loop < graph_.loopCount(), "there is no such loop closure");
  graph_.loops[loop].state = LoopState::kRemoved;
  hierarchy_.drop(graph_, loop);
}

void PoseGraph::Impl::addPrior(int node, const Pose& T_world_node, const PoseCov& cov) {
  require(node >= 0 && node < graph_.nodeCount(), "a prior is for a node that exists");
  require(T_world_node.isValid() && isCovariance6(cov), "a prior is not finite or not positive definite");
  graph_.addPrior(node, T_world_node, cov);
}

void PoseGraph::Impl::addPosition(const OuterPosition& position) {
  require(position.node >= 0 && position.node < graph_.nodeCount(), "a position is of a node that exists");
  require(position.in_node_m.allFinite() && position.measured_m.allFinite(), "a position is not finite");
  require(isCovariance(position.cov_m2), "a position's covariance is not positive definite");
  add(position, graph_.outer);
}

/// Looks whether the positions determine the frame in which they are.
void PoseGraph::Impl::alignOuter() {
  OuterFrame& outer = graph_.outer;
  if (outer.is_aligned || outer.factors.empty()) return;
  std::vector<PointPair> pairs;
  for (const auto& [position, cost] : outer.factors) {
    pairs.push_back({graph_.nodes[position.node].pose() * position.in_node_m, position.measured_m, position.cov_m2});
  }
  const std::optional<Pose> T_outer_world = alignOuterFrame(pairs);
  if (!T_outer_world) return;
  writeBlock(*T_outer_world, outer.block.data());
  outer.is_aligned = true;
}

void PoseGraph::Impl::regroup(std::vector<std::vector<std::int64_t>> groups) {
  for (auto& group : groups) std::sort(group.begin(), group.end());
  check(groups, graph_);
  hierarchy_.touch(graph_.regroup(groups));
}

void PoseGraph::Impl::transfer(StateArchive& archive, const std::vector<PoseNode>& expected) {
  transferGraph(archive, config_, expected, odometry_, graph_, review_);
  archive(hierarchy_, in_hierarchy_, reported_);
  archive.require(hierarchy_.fits(graph_, in_hierarchy_), "a coarse graph of other nodes than there are");
  archive.require(reported_.size() <= graph_.loops.size(), "more loop closures told than there are");
}

void PoseGraph::Impl::transferPositions(StateArchive& archive) {
  graph_.outer.transfer(archive, graph_.nodeCount());
  if (archive.isReading()) hierarchy_.takePositionsAsKnown(graph_);
}

/// True if the solution was not cut short.
bool PoseGraph::Impl::solveWindow(const std::vector<int>& nodes, int iterations, double max_seconds,
                                  PoseGraphUpdate& update) {
  Subgraph window(graph_, nodes, Surroundings::kHeld, config_);
  const Subgraph::Outcome outcome = window.optimize(iterations, max_seconds);
  update.iterations += outcome.iterations;
  update.out_of_time = update.out_of_time || outcome.out_of_time;
  if (!outcome.failure.empty()) update.failure = outcome.failure;
  return outcome.failure.empty() && !outcome.out_of_time;
}

/// True if the skeleton was solved. What there is no time for stays pending for the next call.
bool PoseGraph::Impl::solveGlobally(const Deadline& deadline, PoseGraphUpdate& update) {
  if (!hierarchy_.update(graph_, review_)) return false;
  if (deadline.hasPassed()) {
    update.out_of_time = true;
    return false;
  }
  const Skeleton::Outcome outcome = hierarchy_.solve(graph_, review_, deadline.left_s());
  update.iterations += outcome.iterations;
  update.moved_everything = true;
  update.out_of_time = update.out_of_time || outcome.out_of_time;
  if (!outcome.failure.empty()) {
    update.failure = outcome.failure;
    return false;
  }
  if (!outcome.out_of_time) hierarchy_.settle(graph_);
  return true;
}

PoseGraphUpdate PoseGraph::Impl::optimize() {
  const Deadline deadline(config_.time_budget_s);
  PoseGraphUpdate update;
  const int count = graph_.nodeCount();
  if (count == 0) return update;
  alignOuter();
  solveWindow(range(std::max(0, count - config_.window_nodes), count), config_.window_iterations,
              deadline.left_s(kWindowShare), update);
  hierarchy_.synchronize(graph_);
  const bool has_time = in_hierarchy_ == count;  // no new node
  for (; in_hierarchy_ < count; ++in_hierarchy_) hierarchy_.extend(graph_, review_, in_hierarchy_);
  hierarchy_.linkTouched(graph_, review_);
  review_.decide(graph_);
  closeLoops(deadline, update);
  if (!deadline.hasPassed()) {
    const std::vector<int> touched = hierarchy_.takeTouched(graph_);
    if (!touched.empty()) solveWindow(touched, config_.window_iterations, deadline.left_s(), update);
  }
  const int interval = config_.repair_interval;
  if (interval > 0 && (has_time || count % interval == 0) && !deadline.hasPassed()) {
    const std::vector<int> bent = hierarchy_.takeBentPiece(graph_);
    if (!bent.empty()) solveWindow(bent, kRepairIterations, deadline.left_s(), update);
  }
  update.out_of_time = update.out_of_time || deadline.hasPassed();
  update.loop_changes = takeChanges();
  return update;
}

/// Lets new loop closures act on the whole drive.
void PoseGraph::Impl::closeLoops(const Deadline& deadline, PoseGraphUpdate& update) {
  const bool is_solved = solveGlobally(deadline, update);
  const int count = graph_.nodeCount();
  const bool is_small = count <= config_.whole_nodes && !deadline.hasPassed();
  if (update.failure.empty() && (is_solved || hierarchy_.hasNews()) && is_small) {
    if (solveWindow(range(0, count), config_.window_iterations, deadline.left_s(), update))
      hierarchy_.finishWhole(graph_);
    hierarchy_.synchronize(graph_);
    update.moved_everything = true;
  }
  if (!is_solved || hierarchy_.isPending()) return;
  review_.compareWithEstimate(graph_, [this](int loop) { return hierarchy_.gap(graph_, loop); });
  solveGlobally(deadline, update);  // if that switched any loop closure
}

PoseGraphUpdate PoseGraph::Impl::optimizeFully() {
  PoseGraphUpdate update = optimize();
  if (graph_.nodes.empty()) return update;
  const Subgraph::Outcome outcome = whole(graph_).optimize(kFullIterations, 0.0, kFullTolerance);
  update.iterations += outcome.iterations;
  update.moved_everything = true;
  if (!outcome.failure.empty()) update.failure = outcome.failure;
  if (outcome.failure.empty()) hierarchy_.finishWhole(graph_);
  update.loop_changes = takeChanges();
  return update;
}

LoopDecision PoseGraph::Impl::decision(int loop) const {
  return {loop, graph_.loops[loop].state, mahalanobisSq(graph_, graph_.loops[loop].constraint)};
}

std::vector<LoopDecision> PoseGraph::Impl::takeChanges() {
  std::vector<LoopDecision> changes;
  reported_.resize(graph_.loops.size());
  for (int i = 0; i < graph_.loopCount(); ++i) {
    const LoopState state = graph_.loops[i].state;
    if (reported_[i] == state) continue;
    reported_[i] = state;
    changes.push_back(decision(i));
  }
  return changes;
}

std::vector<LoopDecision> PoseGraph::Impl::decide() {
  review_.decide(graph_);
  return takeChanges();
}

PoseGraph::PoseGraph(const PoseGraphConfig& config) {
  check(config);
  impl_ = std::make_unique<Impl>(config);
}
PoseGraph::~PoseGraph() = default;
PoseGraph::PoseGraph(PoseGraph&&) noexcept = default;
PoseGraph& PoseGraph::operator=(PoseGraph&&) noexcept = default;

int PoseGraph::addNode(const PoseNode& node) {
  return impl_->addNode(node);
}
int PoseGraph::addLoopClosure(const LoopConstraint& loop) {
  return impl_->addLoopClosure(loop);
}
void PoseGraph::removeLoopClosure(int loop) {
  impl_->removeLoopClosure(loop);
}
void PoseGraph::addPrior(int node, const Pose& T_world_node, const PoseCov& cov) {
  impl_->addPrior(node, T_world_node, cov);
}
void PoseGraph::addPosition(const OuterPosition& position) {
  impl_->addPosition(position);
}
void PoseGraph::regroup(const std::vector<std::vector<std::int64_t>>& groups) {
  impl_->regroup(groups);
}
std::vector<LoopDecision> PoseGraph::decide() {
  return impl_->decide();
}
PoseGraphUpdate PoseGraph::optimize() {
  return impl_->optimize();
}
PoseGraphUpdate PoseGraph::optimizeFully() {
  return impl_->optimizeFully();
}
void PoseGraph::transfer(StateArchive& archive, const std::vector<PoseNode>& expected) {
  if (archive.isReading() && nodes() > 0) throw std::logic_error("PoseGraph: a state is read into an empty graph");
  impl_->transfer(archive, expected);
}
void PoseGraph::transferPositions(StateArchive& archive) {
  if (archive.isReading() && positions() > 0)
    throw std::logic_error("PoseGraph: positions are read where there are some");
  impl_->transferPositions(archive);
}

}  // namespace semantic_mht_slam
