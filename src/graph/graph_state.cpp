#include "graph_state.h"

#include <algorithm>
#include <iterator>

#include <Eigen/LU>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {

namespace {

/// A landmark that is being taken apart.
struct OldLandmark {
  int anchor = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< in the frame of the anchor
  std::set<std::int64_t> numbers;                        ///< of its sightings
};

/// Where the nodes of some sightings, as they stand, put a landmark in the world.
Eigen::Vector3d meanOf(const std::vector<SightingFactor>& sightings, const std::deque<NodeState>& nodes) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const SightingFactor& sighting : sightings) {
    const Pose T_world_node = nodes[sighting.node].pose();
    const Eigen::Matrix3d root = sighting.cost->squareRoot() * T_world_node.rotation.conjugate().toRotationMatrix();
    const Eigen::Matrix3d in_world = root.transpose() * root;
    information += in_world;
    weighted += in_world * (T_world_node * sighting.cost->measured());
  }
  return solved(information, weighted);
}

/// The landmark seen first of those that come into a group as a whole; null if there is none.
const OldLandmark* firstWhole(const std::vector<OldLandmark>& old, const std::vector<std::int64_t>& group) {
  const OldLandmark* first = nullptr;
  for (const OldLandmark& landmark : old) {
    const bool is_whole = std::includes(group.begin(), group.end(), landmark.numbers.begin(), landmark.numbers.end());
    if (is_whole && (first == nullptr || landmark.anchor < first->anchor)) first = &landmark;
  }
  return first;
}

}  // namespace

std::int64_t GraphState::keptNumber(std::int64_t landmark) const {
  const auto found = group_of.find(landmark);
  return found == group_of.end() ? landmark : found->second;
}

void GraphState::addSighting(const LandmarkSighting& sighting) {
  const int newest = nodeCount() - 1;
  const std::int64_t number = keptNumber(sighting.landmark);
  const auto [entry, is_new] = landmarks.try_emplace(number);
  LandmarkState& landmark = entry->second;
  if (is_new) {
    landmark.anchor = newest;
    landmark.position_m = sighting.position_m;
  }
  if (is_new || landmark.sightings.back().node != newest) nodes[newest].landmarks.push_back(number);
  landmark.sightings.push_back(
      {newest, sighting.landmark, std::make_unique<PointCost<3>>(sighting.position_m, sighting.cov_m2.inverse())});
}

void GraphState::addLoop(const LoopConstraint& loop) {
  nodes[loop.from].loops.push_back(loopCount());
  nodes[loop.to].loops.push_back(loopCount());
  LoopState3& state = loops.emplace_back();
  state.constraint = loop;
  state.cost = std::make_unique<RelativePose3Cost>(loop.T_from_to, inverted(loop.cov));
}

void GraphState::addPrior(int node, const Pose& T_world_node, const PoseCov& cov) {
  nodes[node].priors.push_back({T_world_node, cov, std::make_unique<RelativePose3Cost>(T_world_node, inverted(cov))});
  ++priors;
}

PoseNode GraphState::node(int index) const {
  const NodeState& state = nodes.at(index);
  PoseNode node;
  node.T_previous_node = state.pose();
  node.shared_errors = state.shared_errors;
  node.T_world_node = state.pose();
  if (state.odometry_cost) {
    const Matrix6d root = state.odometry_cost->squareRoot();
    node.T_previous_node = state.odometry_cost->measured();
    node.odometry_cov = symmetric(inverted(Matrix6d(root.transpose() * root)));
  }
  for (const std::int64_t number : state.landmarks) {
    const std::vector<SightingFactor>& sightings = landmarks.at(number).sightings;
    auto seen = std::lower_bound(sightings.begin(), sightings.end(), index,
                                 [](const SightingFactor& sighting, int i) { return sighting.node < i; });
    for (; seen != sightings.end() && seen->node == index; ++seen) {
      const Eigen::Matrix3d root = seen->cost->squareRoot();
      node.sightings.push_back(
          {seen->landmark, seen->cost->measured(), symmetric((root.transpose() * root).inverse())});
    }
  }
  return node;
}

std::set<int> GraphState::regroup(const std::vector<std::vector<std::int64_t>>& groups) {
  std::map<std::int64_t, std::vector<SightingFactor>> sightings_of;
  std::map<std::int64_t, std::vector<OldLandmark>> old_of;  // by each number
  for (const auto& group : groups) {
    for (const std::int64_t number : group) {
      const auto found = landmarks.find(keptNumber(number));
      if (found == landmarks.end()) continue;
      OldLandmark old{found->second.anchor, found->second.position_m, {}};
      for (SightingFactor& sighting : found->second.sightings) {
        auto& numbers = nodes[sighting.node].landmarks;
        numbers.erase(std::remove(numbers.begin(), numbers.end(), found->first), numbers.end());
        old.numbers.insert(sighting.landmark);
        sightings_of[sighting.landmark].push_back(std::move(sighting));
      }
      for (const std::int64_t own : old.numbers) old_of[own].push_back(old);
      landmarks.erase(found);
    }
  }
  std::set<int> seen_by;
  for (const auto& group : groups) {
    std::vector<SightingFactor> sightings;
    std::vector<OldLandmark> old;
    for (const std::int64_t number : group) {
      group_of[number] = group.front();
      auto& own = sightings_of[number];
      std::move(own.begin(), own.end(), std::back_inserter(sightings));
      old.insert(old.end(), old_of[number].begin(), old_of[number].end());
    }
    if (group.size() == 1) group_of.erase(group.front());
    if (sightings.empty()) continue;
    std::stable_sort(sightings.begin(), sightings.end(),
                     [](const SightingFactor& a, const SightingFactor& b) { return a.node < b.node; });
    for (const SightingFactor& sighting : sightings) {
      auto& numbers = nodes[sighting.node].landmarks;
      if (numbers.empty() || numbers.back() != group.front()) numbers.push_back(group.front());
      seen_by.insert(sighting.node);
    }
    LandmarkState& landmark = landmarks[group.front()];
    landmark.anchor = sightings.front().node;
    const OldLandmark* whole = firstWhole(old, group);
    const bool stays = whole != nullptr && whole->anchor == landmark.anchor;
    const Eigen::Vector3d in_world_m =
        whole != nullptr ? nodes[whole->anchor].pose() * whole->position_m : meanOf(sightings, nodes);
    landmark.position_m = stays ? whole->position_m : nodes[landmark.anchor].pose().inverse() * in_world_m;
    landmark.sightings = std::move(sightings);
  }
  return seen_by;
}

}  // namespace semantic_mht_slam
