#include "graph_archive.h"

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/state_checks.h"

#include "hierarchy.h"
#include "loop_review.h"
#include "skeleton.h"

// The state of a graph as bytes. Costs are written as what they are made of; the order of everything that a solver adds
// up is kept.
namespace semantic_mht_slam {
namespace {

/// A cost as its measurement and the square root of its information.
template <class Cost, class Measured, class Matrix>
void transferCost(StateArchive& archive, Measured measured, Matrix root, std::unique_ptr<Cost>& cost) {
  if (cost) {
    measured = cost->measured();
    root = cost->squareRoot();
  }
  archive(measured, root);
  archive.require(isSquareRoot(root), "a measurement whose information is not positive");
  if (archive.isReading()) cost = std::make_unique<Cost>(measured, SquareRoot<Matrix>{root});
}

void transferCost(StateArchive& archive, std::unique_ptr<RelativePose3Cost>& cost) {
  transferCost(archive, Pose(), Matrix6d(), cost);
}

void transferCost(StateArchive& archive, std::unique_ptr<PointCost<3>>& cost) {
  transferCost(archive, Eigen::Vector3d(), Eigen::Matrix3d(), cost);
}

void requireIndex(int index, std::size_t size) {
  const std::size_t place = index;  // a negative one is beyond any size
  if (place >= size) StateArchive::fail("a number names no part of the graph");
}

bool isAs(const PoseNode& expected, const OdometryStep& step, const SharedErrors& shared_errors) {
  const Pose& pose = expected.T_previous_node;
  return pose.rotation.coeffs() == step.T_previous_node.rotation.coeffs() &&
         pose.translation_m == step.T_previous_node.translation_m && expected.odometry_cov == step.cov &&
         expected.shared_errors == shared_errors;
}

/// The odometry of each node of a graph, without its costs.
void transferOdometry(StateArchive& archive, const std::vector<PoseNode>& expected, std::vector<OdometryStep>& odometry,
                      GraphState& graph) {
  const std::size_t count = archive.count<OdometryStep>(odometry.size());
  if (count != graph.nodes.size()) StateArchive::fail("a graph with more nodes than odometry");
  if (archive.isReading()) odometry.assign(count, {});
  for (std::size_t i = 0; i < count; ++i) {
    OdometryStep& step = odometry[i];
    SharedErrors& shared_errors = graph.nodes[i].shared_errors;
    bool is_expected = i < expected.size() && isAs(expected[i], step, shared_errors);
    archive(is_expected);
    if (!is_expected) archive(step.T_previous_node, step.cov, shared_errors);
    if (is_expected && archive.isReading()) {
      if (i >= expected.size()) StateArchive::fail("odometry that nobody knows");
      step = {expected[i].T_previous_node, expected[i].odometry_cov};
      shared_errors = expected[i].shared_errors;
    }
  }
}

/// Nodes know the landmarks and loop closures that name them, and no others.
void requireReferences(const StateArchive& archive, const GraphState& graph) {
  for (const auto& [number, kept] : graph.group_of) {  // by the lowest number of each group
    archive.require(kept <= number, "landmarks that are kept as each other, in a circle");
  }
  std::vector<std::set<std::int64_t>> landmarks(graph.nodes.size());
  for (const auto& [number, landmark] : graph.landmarks) {
    archive.require(!landmark.sightings.empty() && landmark.sightings.front().node == landmark.anchor,
                    "a landmark that its anchor did not see first");
    int before = landmark.anchor;
    for (const SightingFactor& sighting : landmark.sightings) {
      archive.require(sighting.node >= before && graph.keptNumber(sighting.landmark) == number,
                      "a sighting of another landmark, or out of order");
      before = sighting.node;
      landmarks[sighting.node].insert(number);
    }
  }
  std::vector<std::vector<int>> loops(graph.nodes.size());
  for (int i = 0; i < graph.loopCount(); ++i) {
    loops[graph.loops[i].constraint.from].push_back(i);
    loops[graph.loops[i].constraint.to].push_back(i);
  }
  for (std::size_t i = 0; i < graph.nodes.size(); ++i) {
    const NodeState& node = graph.nodes[i];
    const std::set<std::int64_t> known(node.landmarks.begin(), node.landmarks.end());
    archive.require(known == landmarks[i] && known.size() == node.landmarks.size(),
                    "a node that knows other landmarks than it saw");
    archive.require(node.loops == loops[i], "a node that knows other loop closures than end there");
  }
}

}  // namespace

void transfer(StateArchive& archive, SightingFactor& sighting) {
  archive(sighting.node, sighting.landmark);
  archive.requireName(static_cast<std::uint64_t>(sighting.landmark));
  transferCost(archive, sighting.cost);
}

void transfer(StateArchive& archive, LandmarkState& landmark) {
  archive(landmark.anchor, landmark.position_m, landmark.sightings);
}

void transfer(StateArchive& archive, PriorFactor& prior) {
  archive(prior.T_world_node, prior.cov);
  archive.require(isPositive(prior.cov), "a prior whose covariance is not positive");
  transferCost(archive, prior.cost);
}

/// Without odometry.
void transfer(StateArchive& archive, NodeState& node) {
  archive(node.block, node.landmarks, node.loops, node.priors);
  archive.require(node.pose().isValid(), "a node whose pose is none");
}

void transfer(StateArchive& archive, LoopState3& loop) {
  auto& [from, to, T_from_to, cov, is_certain] = loop.constraint;
  archive(from, to, T_from_to, cov, is_certain, loop.state, loop.is_reviewed, loop.is_readmitted);
  archive.require(isPositive(cov) && from != to, "a loop closure whose covariance is not positive, or of one node");
  archive.require(loop.state >= LoopState::kAccepted && loop.state <= LoopState::kRemoved,
                  "a loop closure in a state that there is not");
  if (archive.isReading()) loop.cost = std::make_unique<RelativePose3Cost>(T_from_to, inverted(cov));
}

void GraphState::transfer(StateArchive& archive) {
  archive(nodes, landmarks, group_of, loops);
  for (const auto& [number, landmark] : landmarks) {
    requireIndex(landmark.anchor, nodes.size());
    for (const SightingFactor& sighting : landmark.sightings) requireIndex(sighting.node, nodes.size());
  }
  priors = 0;
  for (const NodeState& node : nodes) {
    priors += node.priors.size();
    for (const std::int64_t number : node.landmarks) requireIndex(0, landmarks.count(number));
    for (const int loop : node.loops) requireIndex(loop, loops.size());
  }
  for (const LoopState3& loop : loops) {
    requireIndex(loop.constraint.from, nodes.size());
    requireIndex(loop.constraint.to, nodes.size());
  }
  if (archive.isReading()) requireReferences(archive, *this);
}

void LoopReview::transfer(StateArchive& archive, const GraphState& graph) {
  archive(fits_odometry_, agrees_, reviewed_);
  if (fits_odometry_.size() != graph.loops.size() || agrees_.size() != graph.loops.size()) {
    StateArchive::fail("a loop closure was not looked at");
  }
  archive.require(reviewed_ >= 0 && reviewed_ <= graph.loopCount(),
                  "loop closures that were looked at before they came");
  for (int i = firstOpen(graph); i < graph.loopCount(); ++i) {
    const auto needed = static_cast<std::size_t>(std::min(i, config_.compared_loops));
    archive.require(agrees_[i].size() >= needed, "made with fewer graph.compared_loops than now");
  }
  if (!archive.isReading()) return;
  for (const LoopState3& loop : graph.loops) {
    const LoopConstraint& constraint = loop.constraint;
    loops_.push_back(makeTestedLoop<3>(constraint.from, constraint.to, constraint.T_from_to, constraint.cov));
  }
}

void transferGraph(StateArchive& archive, const PoseGraphConfig& config, const std::vector<PoseNode>& expected,
                   std::vector<OdometryStep>& odometry, GraphState& graph, LoopReview& review) {
  int window_nodes = config.window_nodes;
  int chunk_nodes = config.chunk_nodes;
  archive(window_nodes, chunk_nodes);
  if (window_nodes != config.window_nodes || chunk_nodes != config.chunk_nodes) {
    throw InputError("made with graph.window_nodes " + std::to_string(window_nodes) + " and graph.chunk_nodes " +
                     std::to_string(chunk_nodes) + ", other ones than now");
  }
  archive(graph);
  transferOdometry(archive, expected, odometry, graph);
  if (archive.isReading()) {
    for (std::size_t i = 0; i < odometry.size(); ++i) {
      const auto& [T_previous_node, cov] = odometry[i];
      review.extendOdometry(T_previous_node, cov, i == 0);
      if (i == 0) continue;
      archive.require(isPositive(cov), "odometry whose covariance is not positive");
      graph.nodes[i].odometry_cost = std::make_unique<RelativePose3Cost>(T_previous_node, inverted(cov));
    }
  }
  review.transfer(archive, graph);
}

void Hierarchy::LoopLink::transfer(StateArchive& archive) {
  archive(link, is_settled);
}

void Hierarchy::transfer(StateArchive& archive) {
  archive(skeleton_, loop_links_, landmark_links_, touched_, prior_links_, bend_, news_, is_pending_);
  priors_in_ = std::accumulate(prior_links_.begin(), prior_links_.end(), std::size_t{0});
}

bool Hierarchy::fits(const GraphState& graph, int nodes) const {
  const auto isLink = [this](const LoopLink& loop) { return !loop.link || skeleton_.hasLink(*loop.link); };
  const auto isNode = [&](int node) { return node >= 0 && node < nodes; };
  const auto up = [nodes](int size) { return static_cast<std::size_t>((nodes + size - 1) / size); };
  bool fits =
      nodes >= 0 && nodes <= graph.nodeCount() && prior_links_.size() == static_cast<std::size_t>(nodes) &&
      static_cast<std::size_t>(skeleton_.hubs()) == up(config_.chunk_nodes) &&
      bend_.size() == up(config_.window_nodes) && loop_links_.size() <= graph.loops.size() && news_ >= 0.0 &&
      std::all_of(loop_links_.begin(), loop_links_.end(), isLink) &&
      std::all_of(touched_.begin(), touched_.end(), [&](int node) { return node >= 0 && node < graph.nodeCount(); }) &&
      std::all_of(bend_.begin(), bend_.end(), [](double bend_m) { return bend_m >= 0.0; });
  for (const auto& [node, shared] : landmark_links_) fits = fits && isNode(node) && shared.link && isLink(shared);
  for (int i = 0; fits && i < nodes; ++i) fits = prior_links_[i] <= graph.nodes[i].priors.size();
  return fits;
}

void Skeleton::Link::transfer(StateArchive& archive) {
  archive(from, to, is_robust, shared_errors);
  transferCost(archive, cost);
}

std::vector<int> Skeleton::activeLinks() const {
  std::map<ceres::ResidualBlockId, int> link_of;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (links_[i].id != nullptr) link_of[links_[i].id] = static_cast<int>(i);
  }
  std::vector<ceres::ResidualBlockId> blocks;
  problem_.GetResidualBlocks(&blocks);
  std::vector<int> links;
  for (const ceres::ResidualBlockId block : blocks) links.push_back(link_of.at(block));
  return links;
}

void Skeleton::transfer(StateArchive& archive) {
  std::vector<int> active = activeLinks();
  std::vector<std::array<double, kPoseBlock>> hubs(blocks_.begin(), blocks_.end());
  archive(hubs, links_, active);
  if (!archive.isReading()) return;
  for (const auto& block : hubs) {
    Pose pose;
    readBlock(block.data(), pose);
    archive.require(pose.isValid(), "a hub whose pose is none");
    addHub(pose);
  }
  for (const Link& link : links_) {
    if (link.from != kWorld) requireIndex(link.from, hubs.size());
    requireIndex(link.to, hubs.size());
    archive.require(link.from != link.to, "a link of one hub with itself");
  }
  for (const int link : active) {
    requireIndex(link, links_.size());
    setActive(link, true);
  }
}

}  // namespace semantic_mht_slam
