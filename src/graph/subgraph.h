#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/SparseCore>
#include <ceres/loss_function.h>
#include <ceres/problem.h>

#include "ceres_manifold.h"
#include "graph_state.h"

namespace semantic_mht_slam {

/// Which factors a subgraph takes beside those among its own nodes.
enum class Surroundings {
  kHeld,     ///< factors to other nodes count, with the other node held: for optimising in place
  kIgnored,  ///< only factors inside: for what the subgraph alone knows about its own shape
};

/// Some nodes of a graph and all landmarks that they saw, as a problem of its own. The cost functions are lent by the
/// graph, so that setting one up costs a few microseconds a factor, a tenth of one iteration.
class Subgraph {
 public:
  /// `nodes` ascending, without duplicates. The first node of the graph is always held; with kIgnored the first
  /// node of the subgraph is.
  Subgraph(GraphState& graph, std::vector<int> nodes, Surroundings surroundings, const PoseGraphConfig& config);

  struct Outcome {
    std::string failure;  ///< empty, or why nothing was changed
    int iterations = 0;
    bool out_of_time = false;  ///< stopped by the clock; the result is the best estimate up to then
  };

  /// Optimises and writes the result into the graph, until the cost changes by less than `tolerance` of itself.
  /// `max_seconds` 0: no limit; the iteration at work is finished.
  Outcome optimize(int max_iterations, double max_seconds, double tolerance = 1e-4);

  /// Half the squared whitened errors, without robust losses.
  double cost();

  /// What all this knows of a variable node; empty if the problem is singular.
  std::optional<NodeMarginal> marginal(int node);

 private:
  bool isVariable(int node) const;
  bool isInside(int node) const;
  void addPose(int node);
  void addNodeFactors(int node);
  void addLandmark(std::int64_t id);
  void addPositions();
  void addHeldSightings(const LandmarkState& landmark, const Eigen::Vector3d& seen_inside_m, double* block);
  void add(ceres::CostFunction* cost, ceres::LossFunction* loss, double* from, double* to);
  Eigen::MatrixXd sharedGradient(int columns) const;
  void restore(const std::vector<double>& backup);
  std::vector<double> snapshot() const;
  void storeLandmarks();

  GraphState& graph_;
  std::vector<int> nodes_;
  Surroundings surroundings_;
  int fixed_;
  double landmark_scale_;
  std::map<std::int64_t, Eigen::Vector3d> landmarks_;  ///< positions in the world frame while this object lives
  std::array<double, kPoseBlock> world_{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};
  ceres::CauchyLoss loop_loss_;
  ceres::CauchyLoss landmark_loss_;
  PoseManifold manifold_;
  std::deque<PointPriorCost> held_;  ///< what sightings from held nodes say, one a landmark
  bool has_positions_ = false;
  ceres::Problem problem_;
};

}  // namespace semantic_mht_slam
