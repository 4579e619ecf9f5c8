#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "semantic_mht_slam/common/assignment.h"

#include "problem.h"

namespace semantic_mht_slam {

/// A match of the optimal assignment at some state.
struct WeighedPair {
  int detection = 0;
  int landmark = 0;
  double log_odds = 0.0;                                      ///< of the match against none, positive
  double log_peak_odds = 0.0;                                 ///< the same without the residual
  Eigen::Vector3d residual_m = Eigen::Vector3d::Zero();       ///< landmark minus detection
  Eigen::Vector2d turned_m = Eigen::Vector2d::Zero();         ///< detection turned into the state's heading
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();  ///< inverse of the residual's covariance
};

/// Probability that a match is right rather than the detection being new.
double rightProb(const WeighedPair& match);

/// A local optimum of the posterior of the state.
struct LocalOptimum {
  PlanarState state = PlanarState::Zero();
  double log_evidence = 0.0;  ///< against "not here"
  std::vector<WeighedPair> matches;
};

/// Climbs from seeds to modes. A workspace for one problem, which must outlive it.
class Refinement {
 public:
  Refinement(const RegistrationProblem& problem, const RegistrationConfig& config)
      : problem_(problem), config_(config), min_matches_(config.min_matches) {}

  /// Gauss-Newton steps on optimal one-to-one assignments, the first ones under a covariance that covers the coarseness
  /// of the seed. Empty if too few matches remain or they leave the state open.
  std::optional<LocalOptimum> refine(const PlanarState& seed);

 private:
  void addPairs(int index, const PlanarState& state, const Eigen::Matrix3d& turn);
  void addCoarsePairs(int index, const PlanarState& state, const Eigen::Matrix3d& turn);
  void match(const PlanarState& state, bool is_coarse);
  PlanarState step(const PlanarState& state) const;
  bool isDetermined() const;
  double logShareCorrection(bool is_static, const PlanarState& state) const;
  bool isCovered(const LevelledPoint& detection, const PlanarState& state) const;
  double logEvidenceWithoutResiduals(const PlanarState& state) const;
  LocalOptimum modeAt(const PlanarState& state) const;

  const RegistrationProblem& problem_;
  const RegistrationConfig& config_;
  std::size_t min_matches_;
  std::vector<WeighedPair> pairs_;             // with positive odds, by detection
  std::vector<WeighedPair> matches_;           // the pairs of the assignment
  std::vector<std::ptrdiff_t> pair_of_entry_;  // of the cost matrix; -1 for "none"
  SparseCostMatrix costs_;
  AssignmentSolver solver_;
  Assignment assignment_;
};

}  // namespace semantic_mht_slam
