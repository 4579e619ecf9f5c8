#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/graph/pose_graph.h"
#include "semantic_mht_slam/map/map.h"
#include "semantic_mht_slam/models/odometry_model.h"
#include "semantic_mht_slam/slam/back_end_config.h"

namespace semantic_mht_slam {

class StateArchive;

/// How the pose graph fares. Where it cannot be solved, the estimate before stays.
struct GraphStatus {
  std::size_t failures = 0;    ///< solutions that failed
  std::string newest_failure;  ///< what the solver said
};

/// The pose graph of a map: a node a keyframe, a point a landmark, a factor a verified closure.
class MapGraph {
 public:
  MapGraph(const BackEndConfig& config, const ClassTable& classes);

  /// New keyframes, with what each saw; how the odometry between them errs.
  void add(const Map& map, IdRange<KeyframeId> keyframes, const std::vector<std::vector<Sighting>>& sightings,
           const OdometryModel& odometry);

  /// A keyframe as a graph has it that took it by the other `add`, and the same for one that takes it from there.
  PoseNode node(KeyframeId keyframe) const { return graph_.node(static_cast<int>(keyframe.index())); }
  void add(const PoseNode& node) { graph_.addNode(node); }

  /// The next keyframe follows the ones before by a pose in the map, known within about a metre, not by odometry.
  void goOnAt(const Pose& T_map_odom) { T_map_odom_start_ = T_map_odom; }

  /// Whether a keyframe follows the one before as `goOnAt` says.
  bool beginsSession(KeyframeId keyframe) const;

  /// Positions of keyframes in a frame beside the map (see `PoseGraph::addPosition`), for the next solution.
  void add(const std::vector<OuterPosition>& positions);

  /// Where the map is in that frame, as far as it is determined.
  std::optional<Pose> T_outer_map() const { return graph_.T_outer_world(); }

  /// Takes the closures of the map that are verified and new, and decides which of them agree with the odometry and
  /// with each other.
  [[nodiscard]] GraphUpdate review(const Map& map);

  /// Takes a closure out for good; the next `review` says so. Throws std::invalid_argument for one that no `review`
  /// took.
  void removeClosure(ClosureId closure);

  /// Makes one point of the names of each landmark that has `changed` (see `Map::takeChanges`), and solves.
  [[nodiscard]] GraphUpdate optimize(const std::vector<std::vector<LandmarkId>>& changed);

  /// The same for the whole graph at once.
  [[nodiscard]] GraphUpdate optimizeFully(const std::vector<std::vector<LandmarkId>>& changed);

  /// Reviews the closures and solves (the whole graph at once if `is_whole`) until map and graph agree on which
  /// landmarks are one: what closures that are taken back had joined comes apart.
  void settle(Map& map, bool is_whole = false);

  /// Correction of the odometry at the newest keyframe.
  Pose T_map_odom(const Map& map) const;

  /// Corrected position of a landmark, map frame; empty if it is not in the graph.
  std::optional<Eigen::Vector3d> landmark(LandmarkId id) const;

  /// See `PoseGraph`; a node is a keyframe, a landmark is kept by one of its names.
  std::optional<GraphMarginals> marginals() const { return graph_.marginals(); }
  std::optional<std::vector<NodeMarginal>> coarseMarginals() const { return graph_.coarseMarginals(); }
  LandmarkId keptName(LandmarkId id) const;

  /// Deviation of a landmark in a keyframe that more detections do not lower.
  double sightingFloor_m() const { return config_.keyframe.sighting_floor_m; }

  const GraphStatus& status() const { return status_; }

  /// Into an empty graph, or out of one (see `StateArchive`).
  void transfer(StateArchive& archive, const Map& map);

  /// The same of the positions beside the map.
  void transferPositions(StateArchive& archive) { graph_.transferPositions(archive); }

 private:
  std::vector<PoseNode> expectedOdometry(const Map& map) const;
  PoseNode nodeOf(const Map& map, KeyframeId keyframe, const std::vector<Sighting>& sightings,
                  const OdometryModel& odometry);
  void regroup(const std::vector<std::vector<LandmarkId>>& changed);
  std::vector<ClosureDecision> decisionsOf(const std::vector<LoopDecision>& decisions) const;
  GraphUpdate updateOf(const PoseGraphUpdate& update);

  BackEndConfig config_;
  ClassTable classes_;
  PoseGraph graph_;
  std::map<SubmapId, OdometryModel> odometry_;  ///< of submaps, how it was known to err at the end of each
  GraphStatus status_;
  std::vector<ClosureId> closure_of_factor_;
  ClosureId next_closure_{0};             ///< the first that was not looked at
  std::optional<Pose> T_map_odom_start_;  ///< of a session that has no keyframe yet
};

}  // namespace semantic_mht_slam
