#pragma once

#include <deque>
#include <type_traits>
#include <vector>

#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>

#include "semantic_mht_slam/graph/batch_graph.h"

#include "ceres_manifold.h"
#include "cost_functions.h"
#include "pose_block.h"

namespace semantic_mht_slam {

/// Numbers of a pose of a batch graph as Ceres sees it.
template <int kDim>
constexpr int kBatchPoseBlock = kDim == 2 ? kPose2Block : kPoseBlock;

/// A batch graph as a Ceres problem. Cost functions live in deques owned here: thousands of them are built in one go
/// and freed in one go.
template <int kDim>
class BatchProblem {
 public:
  using Graph = BatchGraph<kDim>;
  using PoseCost = std::conditional_t<kDim == 2, RelativePose2Cost, RelativePose3Cost>;

  /// `use_edge[i]` false leaves pose edge i out; `loss` (null: none) is applied to loop closures and points.
  BatchProblem(const Graph& graph, const std::vector<bool>& use_edge, ceres::LossFunction* loss);

  void solve(const ceres::Solver::Options& options, ceres::Solver::Summary& summary);

  /// Copies the estimates back; false, and nothing copied, if one of them is not finite.
  bool store(Graph& graph) const;

 private:
  static ceres::Problem::Options problemOptions();

  double* poseBlock(int index) { return blocks_.data() + index * kBatchPoseBlock<kDim>; }
  double* pointBlock(int index) { return points_.data() + index * kDim; }

  std::vector<double> blocks_;
  std::vector<double> points_;
  std::deque<PoseCost> pose_costs_;
  std::deque<PointCost<kDim>> point_costs_;
  PoseManifold manifold_;
  ceres::Problem problem_;
};

}  // namespace semantic_mht_slam
