#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/pose_cov.h"

namespace semantic_mht_slam {

class StateArchive;

/// Parameters of `PoseGraph`.
struct PoseGraphConfig {
  double loop_cauchy_scale = 1.0;
  double landmark_cauchy_scale = 2.8;
  int window_nodes = 8;
  int chunk_nodes = 10;
  int window_iterations = 3;
  int global_iterations = 4;
  int repair_interval = 4;
  int whole_nodes = 150;
  double time_budget_s = 0.0;
  double loop_gate = 16.812;
  double odometry_cov_scale = 2.0;
  int compared_loops = 64;
};

void describe(PoseGraphConfig& config, Fields& fields);

/// A landmark as one node saw it.
struct LandmarkSighting {
  std::int64_t landmark = 0;                             ///< the same number for the same landmark in every node
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< in the frame of the node
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();
};

/// A new node of the graph.
struct PoseNode {
  Pose T_previous_node;  ///< odometry from the node before; for the first one its pose in the world
  PoseCov odometry_cov = PoseCov::Identity();         ///< integrated along the node before; not used for the first one
  SharedErrors shared_errors = SharedErrors::Zero();  ///< beside `odometry_cov`; widen the covariances of the estimate
  std::vector<LandmarkSighting> sightings;
  std::optional<Pose> T_world_node = std::nullopt;  ///< the first estimate; empty: where the odometry leads
};

/// A place that was recognised.
struct LoopConstraint {
  int from = 0;  ///< index of a node
  int to = 0;    ///< index of another node
  Pose T_from_to;
  PoseCov cov = PoseCov::Identity();
  bool is_certain = false;  ///< takes part whatever speaks against it, without a robust loss
};

/// Where a point of a node is in a frame beside the world: a position by satellites.
struct OuterPosition {
  int node = 0;                                          ///< index of a node
  Eigen::Vector3d in_node_m = Eigen::Vector3d::Zero();   ///< the point, in the frame of the node
  Eigen::Vector3d measured_m = Eigen::Vector3d::Zero();  ///< the same point in the outer frame
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< of that measurement
};

/// Whether a loop closure takes part, and why it does not.
enum class LoopState {
  kAccepted,
  kContradictsOdometry,  ///< further from odometry than its covariance allows
  kInconsistent,         ///< outside the largest set of recent loop closures that agree with each other
  kDoesNotFit,           ///< far from the optimised estimate
  kRemoved,              ///< by `removeLoopClosure`
};

struct LoopDecision {
  int loop = 0;  ///< what `addLoopClosure` returned
  LoopState state = LoopState::kAccepted;
  double mahalanobis_sq = 0.0;  ///< from the present estimate
};

/// How far the estimate may be off, the first node being held.
struct GraphMarginals {
  std::vector<PoseCov> poses;                         ///< by node; a step in the frame of the node
  std::map<std::int64_t, Eigen::Matrix3d> landmarks;  ///< world frame, m^2; by the number that each is kept by
};

/// The same of one node, what comes from errors that all steps share apart: the covariance is `cov` plus
/// `shared * shared^T`.
struct NodeMarginal {
  int node = 0;
  PoseCov cov = PoseCov::Zero();
  SharedErrors shared = SharedErrors::Zero();

  PoseCov total() const { return cov + shared * shared.transpose(); }
};

/// What one call of `optimize` did.
struct PoseGraphUpdate {
  std::string failure;  ///< empty, or why the estimate was kept as it was
  int iterations = 0;
  bool out_of_time = false;       ///< the time budget ended the call; the next ones go on from the estimate reached
  bool moved_everything = false;  ///< the correction went beyond the newest nodes
  std::vector<LoopDecision> loop_changes;  ///< loop closures that were switched on or off
};

/// Pose graph of a drive (paper section III): node poses in SE(3), point landmarks in R^3; odometry with integrated
/// covariance, landmarks relative to the nodes that saw them, loop closures, priors, positions in an outer frame.
/// Errors are whitened with the upper square root of the information; a Cauchy loss is on landmarks and loop closures,
/// none on odometry. The first node is held.
///
/// The time of a call does not grow with the length of the drive as that of a batch solution does: the newest nodes
/// are optimised with everything they see while the rest is held; a new loop closure is solved on a skeleton that has
/// one node a chunk of nodes and condensed factors between them (Grisetti et al., Robust optimization of factor
/// graphs by using condensed measurements, IROS 2012); the nodes between the nodes follow as odometry lets them, and
/// the pieces that were bent most are optimised in full now and then. A graph that is still small is optimised as a
/// whole instead when a loop closes. `optimizeFully` solves everything at once, whatever the size.
///
/// Wrong input (a covariance that is not positive definite, numbers that are not finite, unknown nodes) throws
/// std::invalid_argument and changes nothing. Results do not depend on threads or time unless a time budget is set.
class PoseGraph {
 public:
  explicit PoseGraph(const PoseGraphConfig& config = {});
  ~PoseGraph();
  PoseGraph(PoseGraph&&) noexcept;
  PoseGraph& operator=(PoseGraph&&) noexcept;

  /// Adds a node behind the newest one and returns its index. A landmark's number may occur once in a node.
  int addNode(const PoseNode& node);

  /// Adds a loop closure and returns its index. It takes part from the next `optimize` on, if it is accepted there.
  int addLoopClosure(const LoopConstraint& loop);

  /// Takes a loop closure out for good; the next `optimize` solves without it. Throws std::invalid_argument for one
  /// that there is not.
  void removeLoopClosure(int loop);

  /// Adds absolute knowledge of a pose; `cov` as in `LoopConstraint` with the world as `from`.
  void addPrior(int node, const Pose& T_world_node, const PoseCov& cov);

  /// Adds a position in the outer frame, whose place in the world nobody knows: its z axis is vertical within a few
  /// degrees as the world's is. T_outer_world is estimated with the nodes as soon as most of the positions agree on it
  /// and the way between them is long enough for their noise; until then, they have no effect. A Cauchy loss is on
  /// them. They act on everything at once, not on the newest nodes alone.
  void addPosition(const OuterPosition& position);

  /// Positions added so far.
  std::size_t positions() const;

  /// As it is estimated; empty until it is determined.
  std::optional<Pose> T_outer_world() const;

  /// From now on all numbers of a group mean one landmark, in every call, and no other number does: what was one before
  /// is split into the groups. Sightings keep their own number. Acts like a loop closure: the next `optimize` brings
  /// the places of a merged landmark together, or lets those of a split one go, and optimises the nodes that saw it.
  /// Numbers that no node saw yet are remembered. Throws std::invalid_argument, and changes nothing, for an empty
  /// group, a number in two groups, and groups that leave out a number that is one with a number of theirs.
  void regroup(const std::vector<std::vector<std::int64_t>>& groups);

  /// Decides which new loop closures take part, before `optimize` does so; returns the decisions that changed.
  [[nodiscard]] std::vector<LoopDecision> decide();

  /// Brings the estimate up to date after additions, in time that does not depend on the length of the drive.
  [[nodiscard]] PoseGraphUpdate optimize();

  /// Solves the whole graph, in time that grows with it.
  [[nodiscard]] PoseGraphUpdate optimizeFully();

  int nodes() const;

  /// What was added as a node (see `addNode`), with its present estimate: for a graph that takes this one in. Throws
  /// std::out_of_range.
  PoseNode node(int index) const;

  /// Poses of all nodes in the world frame.
  std::vector<Pose> poses() const;
  Pose pose(int node) const;

  /// Position in the world frame; empty for a landmark that no node saw.
  std::optional<Eigen::Vector3d> landmark(std::int64_t id) const;

  std::vector<LoopDecision> loopDecisions() const;

  /// F of the present estimate: half the squared whitened errors of all factors but rejected loop closures, before
  /// robust losses.
  double cost() const;

  /// Covariances of everything, in time that grows with the graph: for the end of a drive, not for every node. Empty if
  /// the problem is singular.
  std::optional<GraphMarginals> marginals() const;

  /// The same of the first node of every chunk and of the newest node, ascending, by the skeleton as `optimize` left
  /// it: in little of the time of a call of that. Wider than they need be: landmarks that are seen from two chunks tie
  /// them together only where they were seen again.
  std::optional<std::vector<NodeMarginal>> coarseMarginals() const;

  /// The number by which a landmark is kept.
  std::int64_t keptNumber(std::int64_t id) const;

  /// Everything that was added and estimated, so that a graph that reads it goes on to the last bit as the one that
  /// wrote it (see `StateArchive`). Reads only into an empty graph, else throws std::logic_error; throws InputError
  /// also if the state was written with other sizes of windows or chunks. Odometry of nodes that is as `expected` is
  /// not written; whoever reads must expect the same.
  void transfer(StateArchive& archive, const std::vector<PoseNode>& expected);

  /// The same of the positions and the outer frame, after the nodes.
  void transferPositions(StateArchive& archive);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace semantic_mht_slam
