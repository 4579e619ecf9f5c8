#pragma once

#include <algorithm>
#include <functional>
#include <vector>

#include "graph_state.h"
#include "odometry_chain.h"

namespace semantic_mht_slam {

class StateArchive;

/// Of the gate: a loop closure that is in must fit worse to go than to come.
constexpr double kSwitchOffFactor = 3.0;

/// Decides which loop closures of a growing graph take part: pairwise consistency among the newest ones (see
/// `findConsistentLoops`), a bounded number, so that the time does not grow; older decisions stand unless the optimised
/// estimate speaks against them.
///
/// Two loop closures agree if their cycle closes either along odometry or along the present estimate, in both cases
/// with the covariance of odometry: over long stretches the errors of odometry are too large for the linear propagation
/// of covariances, and the estimate, once corrected, is the better place to linearise.
class LoopReview {
 public:
  explicit LoopReview(const PoseGraphConfig& config) : config_(config) {}

  /// A node was added.
  void extendOdometry(const Pose& T_previous_node, const PoseCov& cov, bool is_first);

  /// A loop closure was added.
  void add(const GraphState& graph, const LoopConstraint& loop);

  /// The first loop closure whose state may still change.
  int firstOpen(const GraphState& graph) const { return std::max(0, graph.loopCount() - config_.compared_loops); }

  /// Sets the states of the newest loop closures if there are new ones.
  void decide(GraphState& graph);

  /// Switches off accepted loop closures that are far from the estimate and on those that were out of the consistent
  /// set but fit it. `gap` gives the Mahalanobis distance squared of a loop closure from the estimate.
  void compareWithEstimate(GraphState& graph, const std::function<double(int)>& gap) const;

  /// True if a relative pose agrees with odometry.
  bool fitsOdometry(const GraphState& graph, const LoopConstraint& loop) const;

  /// Covariance of odometry between two nodes, in `PoseCov` form.
  PoseCov odometryCov(int from, int to) const;

  /// The same as a step at the beginning: T_from_to = Exp(step) * T_from_to as expected. Steps add up along odometry.
  PoseCov odometryStepCov(int from, int to) const { return odometry_.between(from, to).cov; }

  /// What was decided, with the loop closures of `graph`; odometry is extended again by whoever reads.
  void transfer(StateArchive& archive, const GraphState& graph);

 private:
  const PoseGraphConfig& config_;
  OdometryChain<3> odometry_;
  std::vector<TestedLoop<3>> loops_;
  std::vector<bool> fits_odometry_;
  std::vector<std::vector<bool>> agrees_;  ///< [newer][newer - older - 1], for the newest ones
  int reviewed_ = 0;

  std::vector<int> candidates(const GraphState& graph) const;
  std::vector<bool> largestAgreement(const std::vector<int>& loops) const;
  UncertainLink<3> estimatedLink(const GraphState& graph, int from, int to) const;
  bool agree(const GraphState& graph, const TestedLoop<3>& a, const TestedLoop<3>& b) const;
};

/// Mahalanobis distance squared of a loop closure from the estimate.
double mahalanobisSq(const GraphState& graph, const LoopConstraint& loop);

}  // namespace semantic_mht_slam
