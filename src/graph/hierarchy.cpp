#include "hierarchy.h"

#include <algorithm>

#include "shared_landmarks.h"
#include "subgraph.h"
#include "tangent.h"

namespace semantic_mht_slam {
namespace {

// A solution takes time in proportion to the nodes and spreads what is new among them: it waits for as much.
constexpr double kQuietGapPerNode = 0.24;
constexpr double kBendRadius_m = 10.0;  // a bend by 1 rad counts like 10 m
constexpr double kWorthRepairing_m = 2e-3;
constexpr double kSwitchOffFactor = 3.0;  // of the gate
constexpr int kRepairMargin = 2;          // submaps on either side of a bent piece that are optimised with it

/// Relative pose between the frames of two nodes from one between submaps that hang on them; with the covariance of its
/// error and of the odometry between submap and node.
struct LiftedLink {
  Pose T_from_to;
  PoseCov cov;
};

LiftedLink lift(const LoopConstraint& loop, const Pose& T_node_from, const Pose& T_node_to, const PoseCov& from_cov,
                const PoseCov& to_cov) {
  const Pose T_to_node = T_node_to.inverse();
  const Matrix6d to_node = adjoint(T_node_to);
  const Matrix6d from_node = adjoint((loop.T_from_to * T_to_node).inverse());
  return {T_node_from * loop.T_from_to * T_to_node,
          to_node * (loop.cov + to_cov) * to_node.transpose() + from_node * from_cov * from_node.transpose()};
}

std::vector<int> range(int first, int last) {
  std::vector<int> numbers;
  for (int i = first; i <= last; ++i) numbers.push_back(i);
  return numbers;
}

}  // namespace

PoseCov errorCov(const Pose& T_world_to, const Eigen::MatrixXd& step_cov) {
  Matrix6d by_step = Matrix6d::Zero();
  by_step.topRightCorner<3, 3>() = T_world_to.rotation.conjugate().toRotationMatrix();
  by_step.bottomLeftCorner<3, 3>().setIdentity();
  return by_step * step_cov * by_step.transpose();
}

Hierarchy::Hierarchy(const PoseGraphConfig& config) : config_(config), skeleton_(config.loop_cauchy_scale) {}

int Hierarchy::nearestNode(int submap) const {
  const int half = config_.chunk_submaps / 2;
  return std::min(chunkOf(submap + half), skeleton_.nodes() - 1);
}

void Hierarchy::extend(GraphState& graph, const LoopReview& review, int newest) {
  prior_links_.push_back(0);
  if (newest % config_.window_submaps == 0) bend_.push_back(0.0);
  if (newest == firstOf(chunkOf(newest))) addNode(graph, review, newest);
  addSharedLandmarks(graph, review, newest);
}

void Hierarchy::addNode(GraphState& graph, const LoopReview& review, int newest) {
  const Pose T_world_new = graph.submaps[newest].pose();
  const int node = skeleton_.addNode(T_world_new);
  if (node == 0) return;
  const int before = firstOf(node - 1);
  const Pose T_before_new = graph.submaps[before].pose().inverse() * T_world_new;
  Subgraph chunk(graph, range(before, newest), Surroundings::kIgnored, config_);
  const auto step_cov = chunk.poseStepCovariance(newest);
  const PoseCov cov = step_cov ? errorCov(T_world_new, *step_cov) : review.odometryCov(before, newest);
  skeleton_.setActive(skeleton_.addLink(node - 1, node, T_before_new, cov), true);
}

std::optional<int> Hierarchy::addLiftedLink(const GraphState& graph, const LoopReview& review,
                                            const LoopConstraint& loop) {
  const int from = nearestNode(loop.from);
  const int to = nearestNode(loop.to);
  if (from == to) return std::nullopt;
  const auto offset_in = [&](int node, int submap) {
    return graph.submaps[firstOf(node)].pose().inverse() * graph.submaps[submap].pose();
  };
  const LiftedLink link = lift(loop, offset_in(from, loop.from), offset_in(to, loop.to),
                               review.odometryCov(firstOf(from), loop.from), review.odometryCov(firstOf(to), loop.to));
  return skeleton_.addLink(from, to, link.T_from_to, link.cov);
}

void Hierarchy::addSharedLandmarks(const GraphState& graph, const LoopReview& review, int submap) {
  if (!graph.submaps[submap].loops.empty()) return;  // a loop closure says the same
  const auto relation = relateThroughLandmarks(graph, submap, config_);
  if (!relation || !review.fitsOdometry(graph, *relation)) return;
  const std::optional<int> link = addLiftedLink(graph, review, *relation);
  if (!link) return;
  skeleton_.setActive(*link, true);
  const auto [entry, is_new] = landmark_links_.try_emplace(submap);
  if (!is_new) skeleton_.setActive(*entry->second.link, false);
  entry->second = {link, false};
  news_ += skeleton_.mahalanobisSq(*link);
}

void Hierarchy::linkTouched(const GraphState& graph, const LoopReview& review) {
  for (const int submap : touched_) addSharedLandmarks(graph, review, submap);
}

std::vector<int> Hierarchy::takeTouched(const GraphState& graph) {
  const int newest = static_cast<int>(graph.submaps.size()) - 1;
  std::set<int> submaps;
  for (const int submap : touched_) {
    for (int i = std::max(0, submap - kRepairMargin); i <= std::min(newest, submap + kRepairMargin); ++i) {
      submaps.insert(i);
    }
  }
  touched_.clear();
  return {submaps.begin(), submaps.end()};
}

void Hierarchy::addPriors(GraphState& graph) {
  if (priors_in_ == graph.priors) return;
  for (int submap = 0; submap < static_cast<int>(graph.submaps.size()); ++submap) {
    const auto& priors = graph.submaps[submap].priors;
    for (std::size_t& i = prior_links_[submap]; i < priors.size(); ++i) {
      const int node = nearestNode(submap);
      const Pose T_submap_node = graph.submaps[submap].pose().inverse() * graph.submaps[firstOf(node)].pose();
      const Matrix6d to_node = adjoint(T_submap_node.inverse());
      const int link = skeleton_.addLink(Skeleton::kWorld, node, priors[i].T_world_submap * T_submap_node,
                                         to_node * priors[i].cov * to_node.transpose());
      skeleton_.setActive(link, true);
      is_pending_ = true;
      ++priors_in_;
    }
  }
}

double Hierarchy::gap(const GraphState& graph, int loop) const {
  const std::optional<int> link = loop_links_[loop].link;
  return link ? skeleton_.mahalanobisSq(*link) : mahalanobisSq(graph, graph.loops[loop].constraint);
}

void Hierarchy::synchronize(const GraphState& graph) {
  for (int node = 0; node < skeleton_.nodes(); ++node) skeleton_.setPose(node, graph.submaps[firstOf(node)].pose());
}

double Hierarchy::quietGap() const {
  return kQuietGapPerNode * skeleton_.nodes();
}

bool Hierarchy::update(GraphState& graph, const LoopReview& review) {
  addPriors(graph);
  const int known = static_cast<int>(loop_links_.size());
  for (int i = std::min(known, review.firstOpen(graph)); i < static_cast<int>(graph.loops.size()); ++i) {
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
  const Skeleton::Outcome outcome = skeleton_.optimize(config_.global_iterations, max_seconds);
  is_pending_ = outcome.failure.empty() && !outcome.converged;
  news_ = 0.0;
  if (outcome.failure.empty()) moveSubmaps(graph, review);
  return outcome;
}

void Hierarchy::settle() {
  for (LoopLink& loop : loop_links_) {
    if (!loop.link || loop.is_settled || skeleton_.mahalanobisSq(*loop.link) > config_.loop_gate) continue;
    skeleton_.setRobust(*loop.link, true);
    loop.is_settled = true;
  }
  for (auto& [submap, shared] : landmark_links_) {
    if (shared.is_settled) continue;
    const double gap = skeleton_.mahalanobisSq(*shared.link);
    if (gap > kSwitchOffFactor * config_.loop_gate) skeleton_.setActive(*shared.link, false);
    skeleton_.setRobust(*shared.link, true);
    shared.is_settled = true;
  }
}

void Hierarchy::moveSubmaps(GraphState& graph, const LoopReview& review) {
  std::vector<Pose> old_nodes;
  for (int node = 0; node < skeleton_.nodes(); ++node) old_nodes.push_back(graph.submaps[firstOf(node)].pose());
  for (int chunk = 0; chunk < skeleton_.nodes(); ++chunk) moveChunk(graph, review, chunk, old_nodes);
}

/// Submaps between two nodes follow as odometry between the nodes lets them: of the step at which the node behind has
/// come to stand otherwise, each takes the share that is expected of it. Those behind the last node follow it rigidly.
void Hierarchy::moveChunk(GraphState& graph, const LoopReview& review, int chunk, const std::vector<Pose>& old_nodes) {
  const Pose T_node_world_old = old_nodes[chunk].inverse();
  const Pose T_world_node = skeleton_.pose(chunk);
  const int first = firstOf(chunk);
  const int next = std::min(firstOf(chunk + 1), static_cast<int>(graph.submaps.size()));
  const auto move = [&](int submap, const Pose& step) {
    writeBlock(T_world_node * step * T_node_world_old * graph.submaps[submap].pose(),
               graph.submaps[submap].block.data());
  };
  if (chunk + 1 == skeleton_.nodes()) {
    for (int i = first; i < next; ++i) move(i, Pose::identity());
    return;
  }
  const Pose T_node_next_old = T_node_world_old * old_nodes[chunk + 1];
  const Vector6d step = offset(T_world_node.inverse() * skeleton_.pose(chunk + 1) * T_node_next_old.inverse());
  const Vector6d pull = review.odometryStepCov(first, next).ldlt().solve(step);
  for (int i = first; i < next; ++i) {
    const Vector6d share = review.odometryStepCov(first, i) * pull;
    move(i, {expRotation(share.tail<3>()), share.head<3>()});
  }
  addBend(first, next - 1, offset(T_node_next_old.inverse() * T_world_node.inverse() * skeleton_.pose(chunk + 1)));
}

void Hierarchy::addBend(int first, int last, const Vector6d& bend) {
  const double share = static_cast<double>(config_.window_submaps) / config_.chunk_submaps;
  for (int piece = first / config_.window_submaps; piece <= last / config_.window_submaps; ++piece) {
    bend_[piece] += share * (bend.head<3>().norm() + kBendRadius_m * bend.tail<3>().norm());
  }
}

std::vector<int> Hierarchy::takeBentPiece(const GraphState& graph) {
  const auto most = std::max_element(bend_.begin(), bend_.end());
  if (most == bend_.end() || *most < kWorthRepairing_m) return {};
  *most = 0.0;
  const int first = static_cast<int>(most - bend_.begin()) * config_.window_submaps;
  const int newest = static_cast<int>(graph.submaps.size()) - 1;
  return range(std::max(0, first - kRepairMargin),
               std::min(newest, first + config_.window_submaps - 1 + kRepairMargin));
}

void Hierarchy::finishWhole(const GraphState& graph) {
  std::fill(bend_.begin(), bend_.end(), 0.0);
  touched_.clear();
  is_pending_ = false;
  news_ = 0.0;
  synchronize(graph);
}

}  // namespace semantic_mht_slam
