#pragma once

#include <algorithm>
#include <cstdint>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/graph/pose_graph.h"

#include "graph_state.h"

namespace semantic_mht_slam {

/// What `PoseGraph` refuses: throws std::invalid_argument with `message` unless `condition` holds.
inline void require(bool condition, const char* message) {
  if (!condition) throw std::invalid_argument(std::string("PoseGraph: ") + message);
}

inline bool isCovariance6(const PoseCov& cov) {
  return cov.allFinite() && cov.isApprox(cov.transpose(), 1e-9) && choleskyOf(cov);
}

inline void check(const PoseNode& node, bool is_first) {
  require(node.T_previous_node.isValid(), "odometry is not a finite pose");
  require(!node.T_world_node || node.T_world_node->isValid(), "an estimate is not a finite pose");
  require(is_first || isCovariance6(node.odometry_cov), "odometry covariance is not positive definite");
  std::vector<std::int64_t> ids;
  for (const LandmarkSighting& sighting : node.sightings) {
    require(sighting.position_m.allFinite(), "a landmark position is not finite");
    require(isCovariance(sighting.cov_m2), "a landmark covariance is not positive definite");
    ids.push_back(sighting.landmark);
  }
  std::sort(ids.begin(), ids.end());
  require(std::adjacent_find(ids.begin(), ids.end()) == ids.end(), "a landmark occurs twice in a node");
}

/// Groups of numbers that are to mean one landmark each.
inline void check(const std::vector<std::vector<std::int64_t>>& groups, const GraphState& graph) {
  std::set<std::int64_t> numbers;
  for (const auto& group : groups) {
    require(!group.empty(), "a group of no landmark");
    for (const std::int64_t number : group) require(numbers.insert(number).second, "a landmark is in two groups");
  }
  for (const std::int64_t number : numbers) {
    const auto found = graph.landmarks.find(graph.keptNumber(number));
    if (found == graph.landmarks.end()) continue;
    for (const SightingFactor& sighting : found->second.sightings) {
      require(numbers.count(sighting.landmark) > 0, "a landmark is split and a part of it left out");
    }
  }
}

inline void check(const PoseGraphConfig& config) {
  require(config.loop_cauchy_scale > 0.0 && config.landmark_cauchy_scale > 0.0, "a Cauchy scale is not positive");
  require(config.window_nodes >= 1 && config.chunk_nodes >= 2, "window or chunk too small");
  require(config.window_iterations >= 1 && config.global_iterations >= 1, "iterations below 1");
  require(config.repair_interval >= 0 && config.whole_nodes >= 0 && config.compared_loops >= 1, "negative count");
  require(config.loop_gate > 0.0 && config.odometry_cov_scale >= 1.0 && config.time_budget_s >= 0.0, "out of range");
}

}  // namespace semantic_mht_slam
