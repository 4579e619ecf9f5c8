#include "shared_landmarks.h"

#include <algorithm>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include "semantic_mht_slam/common/dense_solvers.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMinLandmarks = 5;
constexpr double kOutlierGate = 16.27;  // 99.9 % quantile of chi-square with 3 degrees of freedom
constexpr double kMinReciprocalCondition = 1e-9;

struct Pair {
  Eigen::Vector3d in_node_m;
  Eigen::Vector3d in_hub_m;
  Eigen::Matrix3d information;  ///< of their difference
};

Pose bestFit(const std::vector<Pair>& pairs) {
  Eigen::Matrix3Xd from(3, pairs.size());
  Eigen::Matrix3Xd to(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(i) = pairs[i].in_hub_m;
    to.col(i) = pairs[i].in_node_m;
  }
  return Pose::fromMatrix(Eigen::umeyama(from, to, false).topRows<3>());
}

std::vector<Pair> withoutOutliers(const std::vector<Pair>& pairs, const Pose& T_node_hub) {
  std::vector<Pair> kept;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d error = T_node_hub * pair.in_hub_m - pair.in_node_m;
    if (error.dot(pair.information * error) <= kOutlierGate) kept.push_back(pair);
  }
  return kept;
}

Eigen::Matrix3d informationOf(const PointCost<3>& sighting) {
  return sighting.squareRoot().transpose() * sighting.squareRoot();
}

/// Where the nodes that saw a landmark first put it, in the world. Its estimate will not do: the newest nodes,
/// which may be far from where they belong, have already pulled at it.
Eigen::Vector3d whereFirstSeen(const GraphState& graph, const LandmarkState& landmark, int nodes) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const SightingFactor& sighting : landmark.sightings) {
    if (sighting.node >= landmark.anchor + nodes) break;
    const Pose T_world_node = graph.nodes[sighting.node].pose();
    const Eigen::Matrix3d rotation = T_world_node.rotation.toRotationMatrix();
    const Eigen::Matrix3d in_world = rotation * informationOf(*sighting.cost) * rotation.transpose();
    information += in_world;
    weighted += in_world * (T_world_node * sighting.cost->measured());
  }
  return solved(information, weighted);
}

/// The sightings of old landmarks, first seen before the present window, by a node; by the chunk where that was.
std::map<int, std::vector<Pair>> oldLandmarks(const GraphState& graph, int node, const PoseGraphConfig& config) {
  std::map<int, std::vector<Pair>> result;
  for (const std::int64_t id : graph.nodes[node].landmarks) {
    const LandmarkState& landmark = graph.landmarks.at(id);
    if (landmark.anchor > node - 2 * config.window_nodes) continue;
    const int chunk = landmark.anchor / config.chunk_nodes;
    const Pose T_hub_world = graph.nodes[chunk * config.chunk_nodes].pose().inverse();
    const Eigen::Vector3d in_hub_m = T_hub_world * whereFirstSeen(graph, landmark, config.window_nodes);
    for (auto seen = std::lower_bound(landmark.sightings.begin(), landmark.sightings.end(), node,
                                      [](const SightingFactor&a, int number) { return a.node < number; });
         seen != landmark.sightings.end() && seen->node == node; ++seen) {
      // Half the information: the landmark is not known better than this sighting of it.
      result[chunk].push_back({seen->cost->measured(), in_hub_m, 0.5 * informationOf(*seen->cost)});
    }
  }
  return result;
}

}  // namespace

std::optional<LoopConstraint> relateThroughLandmarks(const GraphState& graph, int node, const PoseGraphConfig& config) {
  int chunk = 0;
  std::vector<Pair> pairs;
  for (const auto& [candidate, candidates] : oldLandmarks(graph, node, config)) {
    if (candidates.size() <= pairs.size()) continue;
    chunk = candidate;
    pairs = candidates;
  }
  if (pairs.size() < kMinLandmarks) return std::nullopt;
  pairs = withoutOutliers(pairs, bestFit(pairs));
  if (pairs.size() < kMinLandmarks) return std::nullopt;
  const Pose T_node_hub = bestFit(pairs);
  const Eigen::Matrix3d rotation = T_node_hub.rotation.toRotationMatrix();
  Matrix6d information = Matrix6d::Zero();
  for (const Pair& pair : pairs) {
    Eigen::Matrix<double, 3, 6> by_step;
    by_step << rotation, -rotation * skew(pair.in_hub_m);
    information += by_step.transpose() * pair.information * by_step;
  }
  const Eigen::LDLT<Matrix6d> factor(information);
  if (factor.info() != Eigen::Success || factor.rcond() < kMinReciprocalCondition) return std::nullopt;
  return LoopConstraint{node, chunk * config.chunk_nodes, T_node_hub, inverted(information)};
}

}  // namespace semantic_mht_slam
