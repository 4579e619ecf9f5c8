#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/graph/pose_graph.h"

#include "cost_functions.h"
#include "pose_block.h"

namespace semantic_mht_slam {

class StateArchive;

/// One sighting of a landmark; its cost function is built once and lent to every problem that needs it.
struct SightingFactor {
  int submap = 0;
  std::unique_ptr<PointCost<3>> cost;
};

struct LandmarkState {
  int anchor = 0;  ///< submap that saw it first; corrections move the landmark with it
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< in the frame of the anchor
  std::vector<SightingFactor> sightings;                 ///< ascending submaps
};

struct PriorFactor {
  Pose T_world_submap;
  PoseCov cov;
  std::unique_ptr<RelativePose3Cost> cost;
};

struct SubmapState {
  std::array<double, kPoseBlock> block;              ///< estimate, as Ceres sees it
  std::unique_ptr<RelativePose3Cost> odometry_cost;  ///< from the submap before; none for the first
  std::vector<std::int64_t> landmarks;               ///< without duplicates, also where two that it saw were merged
  std::vector<int> loops;                            ///< loop closures with an end here
  std::vector<PriorFactor> priors;

  Pose pose() const {
    Pose result;
    readBlock(block.data(), result);
    return result;
  }
};

struct LoopState3 {
  LoopConstraint constraint;
  std::unique_ptr<RelativePose3Cost> cost;
  LoopState state = LoopState::kAccepted;
  bool is_reviewed = false;
  bool is_readmitted = false;  ///< outside the consistent set, but fits the estimate that the others gave
};

/// Everything that was added, with the present estimate. Addresses of blocks never change.
struct GraphState {
  std::deque<SubmapState> submaps;
  std::map<std::int64_t, LandmarkState> landmarks;
  std::map<std::int64_t, std::int64_t> merged_landmarks;  ///< number given up -> number that it was merged into
  std::deque<LoopState3> loops;
  std::size_t priors = 0;  ///< of all submaps together

  /// Into an empty state, or out of one.
  void transfer(StateArchive& archive);

  /// The number under which a landmark is kept, or the given one if it was never merged.
  std::int64_t keptNumber(std::int64_t landmark) const;

  /// Adds a sighting by the newest submap.
  void addSighting(const LandmarkSighting& sighting);

  /// Makes one landmark of two that exist, under the number `survivor`, anchored where either was seen first. Returns
  /// the submaps that saw one of them, ascending.
  std::vector<int> mergeLandmarks(std::int64_t merged, std::int64_t survivor);

  Eigen::Vector3d landmarkInWorld(const LandmarkState& landmark) const {
    return submaps[landmark.anchor].pose() * landmark.position_m;
  }
};

}  // namespace semantic_mht_slam
