#include "hierarchy.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/dense_solvers.h"

#include "shared_landmarks.h"
#include "subgraph.h"
#include "tangent.h"

namespace semantic_mht_slam {
namespace {

// A solution takes time in proportion to the hubs and spreads what is new among them: it waits for as much.
constexpr double kQuietGapPerHub = 0.24;
constexpr double kBendRadius_m = 10.0;  // a bend by 1 rad counts like 10 m
constexpr double kWorthRepairing_m = 2e-3;
constexpr int kRepairMargin = 2;  // nodes on either side of a bent piece that are optimised with it

/// Relative pose between the frames of two hubs from one between nodes that hang on them; with the covariance of its
/// error and of the odometry between node and hub.
struct LiftedLink {
  Pose T_from_to;
  PoseCov cov;
};

LiftedLink lift(const LoopConstraint& loop, const Pose& T_hub_from, const Pose& T_hub_to, const PoseCov& from_cov,
                const PoseCov& to_cov) {
  const Pose T_to_hub = T_hub_to.inverse();
  const Matrix6d to_hub = adjoint(T_hub_to);
  const Matrix6d from_hub = adjoint((loop.T_from_to * T_to_hub).inverse());
  return {T_hub_from * loop.T_from_to * T_to_hub,
          to_hub * (loop.cov + to_cov) * to_hub.transpose() + from_hub * from_cov * from_hub.transpose()};
}

}  // namespace

Hierarchy::Hierarchy(const PoseGraphConfig& config) : config_(config), skeleton_(config.loop_cauchy_scale) {}

int Hierarchy::nearestHub(int node) const {
  const int half = config_.chunk_nodes / 2;
  return std::min(chunkOf(node + half), skeleton_.hubs() - 1);
}

void Hierarchy::extend(GraphState& graph, const LoopReview& review, int newest) {
  prior_links_.push_back(0);
  if (newest % config_.window_nodes == 0) bend_.push_back(0.0);
  if (newest == firstOf(chunkOf(newest))) addHub(graph, review, newest);
  addSharedLandmarks(graph, review, newest);
}

void Hierarchy::addHub(GraphState& graph, const LoopReview& review, int newest) {
  const Pose T_world_new = graph.nodes[newest].pose();
  const int hub = skeleton_.addHub(T_world_new);
  if (hub == 0) return;
  const int before = firstOf(hub - 1);
  const Pose T_before_new = graph.nodes[before].pose().inverse() * T_world_new;
  Subgraph chunk(graph, range(before, newest + 1), Surroundings::kIgnored, config_);
  const auto known = chunk.marginal(newest);
  const PoseCov cov = known ? known->cov : review.odometryCov(before, newest);
  const SharedErrors shared = known ? known->shared : SharedErrors(SharedErrors::Zero());
  skeleton_.setActive(skeleton_.addLink(hub - 1, hub, T_before_new, cov, shared), true);
}

std::optional<std::vector<NodeMarginal>> Hierarchy::marginals(GraphState& graph) const {
  auto result = skeleton_.marginals(outerOfHubs(graph).get());
  const int newest = graph.nodeCount() - 1;
  if (!result || result->empty() || chunkOf(newest) + 1 != skeleton_.hubs()) return std::nullopt;
  for (NodeMarginal& hub : *result) hub.node = firstOf(hub.node);
  const NodeMarginal last = result->back();
  if (last.node == newest) return result;
  Subgraph behind(graph, range(last.node, newest + 1), Surroundings::kIgnored, config_);
  const std::optional<NodeMarginal> relative = behind.marginal(newest);
  if (!relative) return std::nullopt;
  const Matrix6d to_newest = adjoint(graph.nodes[newest].pose().inverse() * graph.nodes[last.node].pose());
  result->push_back({newest, to_newest * last.cov * to_newest.transpose() + relative->cov,
                     to_newest * last.shared + relative->shared});
  return result;
}

std::optional<int> Hierarchy::addLiftedLink(const GraphState& graph, const LoopReview& review,
                                            const LoopConstraint& loop) {
  const int from = nearestHub(loop.from);
  const int to = nearestHub(loop.to);
  if (from == to) return std::nullopt;
  const auto offset_in = [&](int hub, int node) {
    return graph.nodes[firstOf(hub)].pose().inverse() * graph.nodes[node].pose();
  };
  const LiftedLink link = lift(loop, offset_in(from, loop.from), offset_in(to, loop.to),
                               review.odometryCov(firstOf(from), loop.from), review.odometryCov(firstOf(to), loop.to));
  return skeleton_.addLink(from, to, link.T_from_to, link.cov);
}

void Hierarchy::addSharedLandmarks(const GraphState& graph, const LoopReview& review, int node) {
  if (!graph.nodes[node].loops.empty()) return;  // a loop closure says the same
  const auto relation = relateThroughLandmarks(graph, node, config_);
  const bool is_related = relation && review.fitsOdometry(graph, *relation);
  const std::optional<int> link = is_related ? addLiftedLink(graph, review, *relation) : std::nullopt;
  const auto known = landmark_links_.find(node);
  if (known != landmark_links_.end()) {
    skeleton_.setActive(*known->second.link, false);
    if (!link) news_ += quietGap();
    landmark_links_.erase(known);
  }
  if (!link) return;
  skeleton_.setActive(*link, true);
  landmark_links_[node] = {link, false};
  news_ += skeleton_.mahalanobisSq(*link);
}

void Hierarchy::linkTouched(const GraphState& graph, const LoopReview& review) {
  for (const int node : touched_) addSharedLandmarks(graph, review, node);
}

void Hierarchy::drop(const GraphState& graph, int loop) {
  touch({graph.loops[loop].constraint.from, graph.loops[loop].constraint.to});
  if (loop >= static_cast<int>(loop_links_.size())) return;
  const std::optional<int> link = loop_links_[loop].link;
  if (!link || !skeleton_.isActive(*link)) return;
  skeleton_.setActive(*link, false);
  is_pending_ = true;
}

std::vector<int> Hierarchy::takeTouched(const GraphState& graph) {
  const int newest = graph.nodeCount() - 1;
  std::set<int> nodes;
  for (const int node : touched_) {
    for (int i = std::max(0, node - kRepairMargin); i <= std::min(newest, node + kRepairMargin); ++i) {
      nodes.insert(i);
    }
  }
  touched_.clear();
  return {nodes.begin(), nodes.end()};
}

void Hierarchy::addPriors(GraphState& graph) {
  if (priors_in_ == graph.priors) return;
  for (int node = 0; node < graph.nodeCount(); ++node) {
    const auto& priors = graph.nodes[node].priors;
    for (std::size_t& i = prior_links_[node]; i < priors.size(); ++i) {
      const int hub = nearestHub(node);
      const Pose T_node_hub = graph.nodes[node].pose().inverse() * graph.nodes[firstOf(hub)].pose();
      const Matrix6d to_hub = adjoint(T_node_hub.inverse());
      const int link = skeleton_.addLink(Skeleton::kWorld, hub, priors[i].T_world_node * T_node_hub,
                                         to_hub * priors[i].cov * to_hub.transpose());
      skeleton_.setActive(link, true);
      is_pending_ = true;
      ++priors_in_;
    }
  }
}

/// What is far from the estimate is news, but a wrong position must not be more than several right ones.
void Hierarchy::noticePositions(const GraphState& graph) {
  const OuterFrame& outer = graph.outer;
  if (!outer.is_aligned) return;
  is_pending_ = is_pending_ || (positions_in_ == 0 && !outer.factors.empty());
  for (; positions_in_ < outer.factors.size(); ++positions_in_) {
    const OuterFrame::Factor& factor = outer.factors[positions_in_];
    news_ += std::log1p(outer.distanceSq(factor, graph.nodes[factor.position.node].block.data()));
  }
}

void Hierarchy::takePositionsAsKnown(const GraphState& graph) {
  positions_in_ = graph.outer.is_aligned ? graph.outer.factors.size() : 0;
}

/// The outer frame with the positions seen from the nearest hubs, as the chunks are shaped now; none without any.
std::unique_ptr<OuterFrame> Hierarchy::outerOfHubs(const GraphState& graph) const {
  if (!graph.outer.is_aligned) return nullptr;
  auto outer = std::make_unique<OuterFrame>();
  outer->is_aligned = true;
  outer->block = graph.outer.block;
  for (const OuterFrame::Factor& factor : graph.outer.factors) {
    OuterPosition position = factor.position;
    const Pose T_world_node = graph.nodes[position.node].pose();
    position.node = nearestHub(position.node);
    const Pose T_hub_node = graph.nodes[firstOf(position.node)].pose().inverse() * T_world_node;
    outer->factors.push_back({position, factor.cost->seenFrom(T_hub_node)});
  }
  return outer;
}

double Hierarchy::gap(const GraphState& graph, int loop) const {
  const std::optional<int> link = loop_links_[loop].link;
  return link ? skeleton_.mahalanobisSq(*link) : mahalanobisSq(graph, graph.loops[loop].constraint);
}

void Hierarchy::synchronize(const GraphState& graph) {
  for (int hub = 0; hub < skeleton_.hubs(); ++hub) skeleton_.setPose(hub, graph.nodes[firstOf(hub)].pose());
}

double Hierarchy::quietGap() const {
  return kQuietGapPerHub * skeleton_.hubs();
}

bool Hierarchy::update(GraphState& graph, const LoopReview& review) {
  addPriors(graph);
  noticePositions(graph);
  const int known = static_cast<int>(loop_links_.size());
  for (int i = std::min(known, review.firstOpen(graph)); i < graph.loopCount(); ++i) {
    const bool is_new = i >= known;
    if (is_new) loop_links_.push_back({addLiftedLink(graph, review, graph.loops[i].constraint), false});
    const bool is_active = graph.loops[i].state == LoopState::kAccepted;
    const std::optional<int> link = loop_links_[i].link;
    if (!link || skeleton_.isActive(*link) == is_active) continue;
    skeleton_.setActive(*link, is_active);
    news_ += is_active ? skeleton_.mahalanobisSq(*link) : quietGap();
  }
  is_pending_ = is_pending_ || news_ > quietGap();
  return is_pending_;
}

Skeleton::Outcome Hierarchy::solve(GraphState& graph, const LoopReview& review, double max_seconds) {
  const std::unique_ptr<OuterFrame> outer = outerOfHubs(graph);
  const Skeleton::Outcome outcome = skeleton_.optimize(config_.global_iterations, max_seconds, outer.get());
  is_pending_ = outcome.failure.empty() && !outcome.converged;
  news_ = 0.0;
  if (outcome.failure.empty() && outer) graph.outer.block = outer->block;
  if (outcome.failure.empty()) moveNodes(graph, review);
  return outcome;
}

void Hierarchy::settle(const GraphState& graph) {
  for (std::size_t i = 0; i < loop_links_.size(); ++i) {
    LoopLink& loop = loop_links_[i];
    if (!loop.link || loop.is_settled || graph.loops[i].constraint.is_certain ||
        skeleton_.mahalanobisSq(*loop.link) > config_.loop_gate)
      continue;
    skeleton_.setRobust(*loop.link, true);
    loop.is_settled = true;
  }
  for (auto& [node, shared] : landmark_links_) {
    if (shared.is_settled) continue;
    const double gap = skeleton_.mahalanobisSq(*shared.link);
    if (gap > kSwitchOffFactor * config_.loop_gate) skeleton_.setActive(*shared.link, false);
    skeleton_.setRobust(*shared.link, true);
    shared.is_settled = true;
  }
}

void Hierarchy::moveNodes(GraphState& graph, const LoopReview& review) {
  std::vector<Pose> old_hubs;
  for (int hub = 0; hub < skeleton_.hubs(); ++hub) old_hubs.push_back(graph.nodes[firstOf(hub)].pose());
  for (int chunk = 0; chunk < skeleton_.hubs(); ++chunk) moveChunk(graph, review, chunk, old_hubs);
}

/// Nodes between two hubs follow as odometry between the hubs lets them: of the step at which the hub behind has
/// come to stand otherwise, each takes the share that is expected of it. Those behind the last hub follow it rigidly.
void Hierarchy::moveChunk(GraphState& graph, const LoopReview& review, int chunk, const std::vector<Pose>& old_hubs) {
  const Pose T_hub_world_old = old_hubs[chunk].inverse();
  const Pose T_world_hub = skeleton_.pose(chunk);
  const int first = firstOf(chunk);
  const int next = std::min(firstOf(chunk + 1), graph.nodeCount());
  const auto move = [&](int node, const Pose& step) {
    writeBlock(T_world_hub * step * T_hub_world_old * graph.nodes[node].pose(), graph.nodes[node].block.data());
  };
  if (chunk + 1 == skeleton_.hubs()) {
    for (int i = first; i < next; ++i) move(i, Pose::identity());
    return;
  }
  const Pose T_hub_next_old = T_hub_world_old * old_hubs[chunk + 1];
  const Vector6d step = offset(T_world_hub.inverse() * skeleton_.pose(chunk + 1) * T_hub_next_old.inverse());
  const Vector6d pull = solved(review.odometryStepCov(first, next), step);
  for (int i = first; i < next; ++i) {
    const Vector6d share = review.odometryStepCov(first, i) * pull;
    move(i, {expRotation(share.tail<3>()), share.head<3>()});
  }
  addBend(first, next - 1, offset(T_hub_next_old.inverse() * T_world_hub.inverse() * skeleton_.pose(chunk + 1)));
}

void Hierarchy::addBend(int first, int last, const Vector6d& bend) {
  const double share = static_cast<double>(config_.window_nodes) / config_.chunk_nodes;
  for (int piece = first / config_.window_nodes; piece <= last / config_.window_nodes; ++piece) {
    bend_[piece] += share * (bend.head<3>().norm() + kBendRadius_m * bend.tail<3>().norm());
  }
}

std::vector<int> Hierarchy::takeBentPiece(const GraphState& graph) {
  const auto most = std::max_element(bend_.begin(), bend_.end());
  if (most == bend_.end() || *most < kWorthRepairing_m) return {};
  *most = 0.0;
  const int first = static_cast<int>(most - bend_.begin()) * config_.window_nodes;
  return range(std::max(0, first - kRepairMargin),
               std::min(graph.nodeCount(), first + config_.window_nodes + kRepairMargin));
}

void Hierarchy::finishWhole(const GraphState& graph) {
  std::fill(bend_.begin(), bend_.end(), 0.0);
  touched_.clear();
  is_pending_ = false;
  news_ = 0.0;
  synchronize(graph);
}

}  // namespace semantic_mht_slam
