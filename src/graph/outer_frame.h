#pragma once

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/sized_cost_function.h>

#include "semantic_mht_slam/graph/pose_graph.h"

#include "ceres_manifold.h"
#include "cost_functions.h"

namespace semantic_mht_slam {

class PoseInformation;
class StateArchive;

/// A point of a node, measured in the outer frame; blocks of `PoseManifold`: T_outer_world and the node.
class OuterPointCost final : public ceres::SizedCostFunction<3, 7, 7> {
 public:
  OuterPointCost(const Eigen::Vector3d& in_node_m, const Eigen::Vector3d& measured_m, const Eigen::Matrix3d& cov_m2);

  /// The same measurement of a point that is seen from another node.
  std::unique_ptr<OuterPointCost> seenFrom(const Pose& T_other_node) const;

  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;

 private:
  OuterPointCost(const Eigen::Vector3d& in_node_m, const Eigen::Vector3d& measured_m,
                 const SquareRoot<Eigen::Matrix3d>& root)
      : in_node_m_(in_node_m), measured_m_(measured_m), sqrt_info_(root.upper) {}

  Eigen::Vector3d in_node_m_;
  Eigen::Vector3d measured_m_;
  Eigen::Matrix3d sqrt_info_;
};

/// The vertical of the outer frame is that of the world within a few degrees; block T_outer_world.
class TiltCost final : public ceres::SizedCostFunction<2, 7> {
 public:
  bool Evaluate(double const* const* blocks, double* residuals, double** jacobians) const override;
};

/// The frame beside the world in which positions were measured (see `PoseGraph::addPosition`), with what was measured.
struct OuterFrame {
  struct Factor {
    OuterPosition position;
    std::unique_ptr<OuterPointCost> cost;
  };

  std::deque<Factor> factors;
  bool is_aligned = false;  ///< the block holds an estimate, and the factors take part
  std::array<double, kPoseBlock> block{0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0};  ///< T_outer_world
  PoseManifold manifold;
  TiltCost tilt;
  ceres::CauchyLoss loss{kCauchyScale};

  static constexpr double kCauchyScale = 1.5;  // standard deviations; a wrong position hardly pulls

  using BlockOf = std::function<double*(int node)>;

  /// Adds everything to a problem that holds the nodes.
  void addTo(ceres::Problem& problem, const BlockOf& block_of);

  /// Adds what the factors know to that of the nodes; the frame is number `frame` of the poses.
  void addTo(PoseInformation& poses, int frame, const std::function<const double*(int node)>& block_of) const;

  /// Squared whitened distance of a measurement from the estimate.
  double distanceSq(const Factor& factor, const double* node_block) const;

  std::optional<Pose> T_outer_world() const;

  /// Into a frame without anything, or out of one; `nodes` are there.
  void transfer(StateArchive& archive, int nodes);
};

void add(const OuterPosition& position, OuterFrame& frame);

}  // namespace semantic_mht_slam
