#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <numeric>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/graph/pose_graph.h"

#include "cost_functions.h"
#include "outer_frame.h"
#include "pose_block.h"

namespace semantic_mht_slam {

class StateArchive;

/// The numbers from `first` on, before `end`.
inline std::vector<int> range(int first, int end) {
  std::vector<int> numbers(end - first);
  std::iota(numbers.begin(), numbers.end(), first);
  return numbers;
}

/// One sighting of a landmark; its cost function is built once and lent to every problem that needs it.
struct SightingFactor {
  int node = 0;
  std::int64_t landmark = 0;  ///< the number that the node gave it
  std::unique_ptr<PointCost<3>> cost;
};

struct LandmarkState {
  int anchor = 0;  ///< node that saw it first; corrections move the landmark with it
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< in the frame of the anchor
  std::vector<SightingFactor> sightings;                 ///< ascending nodes
};

struct PriorFactor {
  Pose T_world_node;
  PoseCov cov;
  std::unique_ptr<RelativePose3Cost> cost;
};

struct NodeState {
  std::array<double, kPoseBlock> block;               ///< estimate, as Ceres sees it
  std::unique_ptr<RelativePose3Cost> odometry_cost;   ///< from the node before; none for the first
  SharedErrors shared_errors = SharedErrors::Zero();  ///< of that odometry
  std::vector<std::int64_t> landmarks;                ///< without duplicates, also where two that it saw were merged
  std::vector<int> loops;                             ///< loop closures with an end here
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
  std::deque<NodeState> nodes;
  std::map<std::int64_t, LandmarkState> landmarks;
  std::map<std::int64_t, std::int64_t> group_of;  ///< number by which a landmark is kept, of those that have several
  std::deque<LoopState3> loops;
  std::size_t priors = 0;  ///< of all nodes together
  OuterFrame outer;        ///< with the positions of nodes in it

  int nodeCount() const { return static_cast<int>(nodes.size()); }
  int loopCount() const { return static_cast<int>(loops.size()); }

  /// Into an empty state, or out of one; without the outer frame, which has a place of its own.
  void transfer(StateArchive& archive);

  /// The number by which the landmark with a number is kept.
  std::int64_t keptNumber(std::int64_t landmark) const;

  /// Adds a sighting by the newest node, a loop closure, a prior; all are sound.
  void addSighting(const LandmarkSighting& sighting);
  void addLoop(const LoopConstraint& loop);
  void addPrior(int node, const Pose& T_world_node, const PoseCov& cov);

  /// See `PoseGraph::node`.
  PoseNode node(int index) const;

  /// See `PoseGraph::regroup`; every group rising. A landmark stays where the one is that was seen first of those that
  /// come into it as a whole; a part of one stands where its sightings put it. Returns the nodes that saw one of them.
  std::set<int> regroup(const std::vector<std::vector<std::int64_t>>& groups);

  Eigen::Vector3d landmarkInWorld(const LandmarkState& landmark) const {
    return nodes[landmark.anchor].pose() * landmark.position_m;
  }
};

}  // namespace semantic_mht_slam
