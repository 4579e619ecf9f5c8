#include "shared_landmarks.h"

#include <algorithm>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kMinLandmarks = 5;
constexpr double kOutlierGate = 16.27;  // 99.9 % quantile of chi-square with 3 degrees of freedom
constexpr double kMinReciprocalCondition = 1e-9;

struct Pair {
  Eigen::Vector3d in_submap_m;
  Eigen::Vector3d in_node_m;
  Eigen::Matrix3d information;  ///< of their difference
};

Pose bestFit(const std::vector<Pair>& pairs) {
  Eigen::Matrix3Xd from(3, pairs.size());
  Eigen::Matrix3Xd to(3, pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    from.col(static_cast<Eigen::Index>(i)) = pairs[i].in_node_m;
    to.col(static_cast<Eigen::Index>(i)) = pairs[i].in_submap_m;
  }
  return Pose::fromMatrix(Eigen::umeyama(from, to, false).topRows<3>());
}

std::vector<Pair> withoutOutliers(const std::vector<Pair>& pairs, const Pose& T_submap_node) {
  std::vector<Pair> kept;
  for (const Pair& pair : pairs) {
    const Eigen::Vector3d error = T_submap_node * pair.in_node_m - pair.in_submap_m;
    if (error.dot(pair.information * error) <= kOutlierGate) kept.push_back(pair);
  }
  return kept;
}

Eigen::Matrix3d informationOf(const PointCost<3>& sighting) {
  return sighting.squareRoot().transpose() * sighting.squareRoot();
}

/// Where the submaps that saw a landmark first put it, in the world. Its estimate will not do: the newest submaps,
/// which may be far from where they belong, have already pulled at it.
Eigen::Vector3d whereFirstSeen(const GraphState& graph, const LandmarkState& landmark, int submaps) {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const SightingFactor& sighting : landmark.sightings) {
    if (sighting.submap >= landmark.anchor + submaps) break;
    const Pose T_world_submap = graph.submaps[sighting.submap].pose();
    const Eigen::Matrix3d rotation = T_world_submap.rotation.toRotationMatrix();
    const Eigen::Matrix3d in_world = rotation * informationOf(*sighting.cost) * rotation.transpose();
    information += in_world;
    weighted += in_world * (T_world_submap * sighting.cost->measured());
  }
  return information.ldlt().solve(weighted);
}

/// The sightings of old landmarks, first seen before the present window, by a submap; by the chunk where that was.
std::map<int, std::vector<Pair>> oldLandmarks(const GraphState& graph, int submap, const PoseGraphConfig& config) {
  std::map<int, std::vector<Pair>> result;
  for (const std::int64_t id : graph.submaps[submap].landmarks) {
    const LandmarkState& landmark = graph.landmarks.at(id);
    if (landmark.anchor > submap - 2 * config.window_submaps) continue;
    const int chunk = landmark.anchor / config.chunk_submaps;
    const Pose T_node_world = graph.submaps[chunk * config.chunk_submaps].pose().inverse();
    const Eigen::Vector3d in_node_m = T_node_world * whereFirstSeen(graph, landmark, config.window_submaps);
    for (auto seen = std::lower_bound(landmark.sightings.begin(), landmark.sightings.end(), submap,
                                      [](const SightingFactor&a, int number) { return a.submap < number; });
         seen != landmark.sightings.end() && seen->submap == submap; ++seen) {
      // Half the information: the landmark is not known better than this sighting of it.
      result[chunk].push_back({seen->cost->measured(), in_node_m, 0.5 * informationOf(*seen->cost)});
    }
  }
  return result;
}

}  // namespace

std::optional<LoopConstraint> relateThroughLandmarks(const GraphState& graph, int submap,
                                                     const PoseGraphConfig& config) {
  int chunk = 0;
  std::vector<Pair> pairs;
  for (const auto& [candidate, candidates] : oldLandmarks(graph, submap, config)) {
    if (candidates.size() <= pairs.size()) continue;
    chunk = candidate;
    pairs = candidates;
  }
  if (pairs.size() < kMinLandmarks) return std::nullopt;
  pairs = withoutOutliers(pairs, bestFit(pairs));
  if (pairs.size() < kMinLandmarks) return std::nullopt;
  const Pose T_submap_node = bestFit(pairs);
  const Eigen::Matrix3d rotation = T_submap_node.rotation.toRotationMatrix();
  Matrix6d information = Matrix6d::Zero();
  for (const Pair& pair : pairs) {
    Eigen::Matrix<double, 3, 6> by_step;
    by_step << rotation, -rotation * skew(pair.in_node_m);
    information += by_step.transpose() * pair.information * by_step;
  }
  const Eigen::LDLT<Matrix6d> factor(information);
  if (factor.info() != Eigen::Success || factor.rcond() < kMinReciprocalCondition) return std::nullopt;
  return LoopConstraint{submap, chunk * config.chunk_submaps, T_submap_node, information.inverse()};
}

}  // namespace semantic_mht_slam
