#pragma once

#include <optional>
#include <vector>

#include "semantic_mht_slam/common/assignment.h"

#include "alignment_problem.h"

namespace semantic_mht_slam {

/// A match of the optimal assignment at some offset.
struct AlignmentMatch {
  int detection = 0;
  int landmark = 0;
  double log_odds = 0.0;                                      ///< of the match against none, positive
  Eigen::Vector3d residual_m = Eigen::Vector3d::Zero();       ///< landmark minus detection
  Eigen::Vector2d turned_m = Eigen::Vector2d::Zero();         ///< detection turned into the offset's heading
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< inverse of the residual's covariance
};

/// A local optimum of the posterior of the offset.
struct AlignmentMode {
  AlignmentState state = AlignmentState::Zero();
  Eigen::Matrix4d cov = Eigen::Matrix4d::Zero();  ///< of the state
  double log_evidence = 0.0;                      ///< against "not here before"
  std::vector<AlignmentMatch> matches;
};

/// Climbs from seeds to modes. A workspace for one problem, which must outlive it.
class AlignmentRefinement {
 public:
  AlignmentRefinement(const AlignmentProblem& problem, const JointAlignmentConfig& config)
      : problem_(problem), config_(config) {}

  /// Gauss-Newton steps on optimal one-to-one assignments, the first ones under a covariance that covers the coarseness
  /// of the seed. Empty if too few matches remain or they leave the offset open.
  std::optional<AlignmentMode> refine(const AlignmentState& seed);

 private:
  void addPairs(int index, const AlignmentState& state, const Eigen::Matrix3d& turn, bool is_coarse);
  void match(const AlignmentState& state, bool is_coarse);
  AlignmentState step(const AlignmentState& state) const;
  bool isDetermined() const;
  double logShareCorrection(bool is_static) const;
  AlignmentMode modeAt(const AlignmentState& state) const;

  const AlignmentProblem& problem_;
  const JointAlignmentConfig& config_;
  std::vector<AlignmentMatch> pairs_;    // with positive odds, by detection
  std::vector<AlignmentMatch> matches_;  // the pairs of the assignment
  std::vector<int> pair_of_entry_;       // of the cost matrix; -1 for "none"
  SparseCostMatrix costs_;
  AssignmentSolver solver_;
  Assignment assignment_;
};

}  // namespace semantic_mht_slam
