#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <ceres/loss_function.h>

#include "block_cholesky.h"
#include "graph_state.h"

namespace semantic_mht_slam {

/// The factor of a relative pose at two blocks, whitened, and the weight that a robust loss gives it.
struct WhitenedRelation {
  Matrix6d by_from;
  Matrix6d by_to;
  double weight = 1.0;
};

WhitenedRelation whiten(const RelativePose3Cost& cost, const ceres::LossFunction* loss, const double* from,
                        const double* to);

/// What factors know of poses of which the first is held, and what errors that many of them share do to the estimate.
/// Shared errors take no part in the estimate, which takes them for what is expected of them: they are "considered"
/// (Schmidt, Application of state-space methods to navigation problems, 1966). Steps are those of `PoseManifold`.
class PoseInformation {
 public:
  /// Factors may join any two of a clique.
  PoseInformation(int poses, const std::vector<std::vector<int>>& cliques);

  /// Adds a relative pose with the weight that a robust loss gives it. A negative `from` is held.
  void add(const RelativePose3Cost& cost, const ceres::LossFunction* loss, int from, const double* from_block, int to,
           const double* to_block, const SharedErrors& shared);

  void add(int a, int b, const Matrix6d& information);

  /// False if the poses are not determined.
  [[nodiscard]] bool solve();

  /// Covariance of the steps of two poses of a clique without and with the shared errors; after `solve`.
  Matrix6d ownStepCov(int a, int b) const;
  Matrix6d stepCov(int a, int b) const { return ownStepCov(a, b) + sharedStep(a) * sharedStep(b).transpose(); }

  /// Step from the estimate to the truth that each shared error, of one standard deviation, makes.
  SharedErrors sharedStep(int pose) const;

 private:
  BlockCholesky cholesky_;    ///< of the poses behind the first
  Eigen::MatrixXd gradient_;  ///< of the shared errors; their effect on the poses after `solve`
};

/// Covariances of all poses and landmarks at the present estimate; empty if something is not determined.
std::optional<GraphMarginals> marginalsOf(const GraphState& graph, const PoseGraphConfig& config);

/// Covariance of the error e (translation, rotation; see `BatchGraph`) of a relative pose, from that of a step of its
/// end (rotation, translation in the world), and a shared part of that error.
PoseCov errorCov(const Pose& T_world_to, const Eigen::MatrixXd& step_cov);
SharedErrors sharedErrors(const Pose& T_world_to, const Eigen::MatrixXd& step);

}  // namespace semantic_mht_slam
