#include "batch_problem.h"

#include <algorithm>
#include <cmath>

namespace semantic_mht_slam {

template <int kDim>
ceres::Problem::Options BatchProblem<kDim>::problemOptions() {
  ceres::Problem::Options options;
  options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  keepManifoldOwnership(options);
  options.disable_all_safety_checks = true;  // indices were checked by findDefect
  return options;
}

template <int kDim>
BatchProblem<kDim>::BatchProblem(const Graph& graph, const std::vector<bool>& use_edge, ceres::LossFunction* loss)
    : blocks_(graph.poses.size() * kBatchPoseBlock<kDim>),
      points_(graph.points.size() * kDim),
      problem_(problemOptions()) {
  for (int i = 0; i < graph.poseCount(); ++i) {
    writeBlock(graph.poses[i].T_world_vertex, poseBlock(i));
    problem_.AddParameterBlock(poseBlock(i), kBatchPoseBlock<kDim>);
    if (kDim == 3) setManifold(problem_, poseBlock(i), &manifold_);
  }
  for (int i = 0; i < graph.pointCount(); ++i) {
    std::copy_n(graph.points[i].position_m.data(), kDim, pointBlock(i));
    problem_.AddParameterBlock(pointBlock(i), kDim);
  }
  for (std::size_t i = 0; i < graph.pose_edges.size(); ++i) {
    if (!use_edge[i]) continue;
    const auto& edge = graph.pose_edges[i];
    ceres::CostFunction* cost = &pose_costs_.emplace_back(edge.T_from_to, edge.information);
    problem_.AddResidualBlock(cost, isOdometry(edge) ? nullptr : loss, poseBlock(edge.from), poseBlock(edge.to));
  }
  for (const auto& edge : graph.point_edges) {
    ceres::CostFunction* cost = &point_costs_.emplace_back(edge.position_m, edge.information);
    problem_.AddResidualBlock(cost, loss, poseBlock(edge.pose), pointBlock(edge.point));
  }
  if (graph.fixed_poses.empty()) problem_.SetParameterBlockConstant(poseBlock(0));
  for (const int index : graph.fixed_poses) problem_.SetParameterBlockConstant(poseBlock(index));
}

template <int kDim>
void BatchProblem<kDim>::solve(const ceres::Solver::Options& options, ceres::Solver::Summary& summary) {
  ceres::Solve(options, &problem_, &summary);
}

template <int kDim>
bool BatchProblem<kDim>::store(Graph& graph) const {
  const auto is_finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(blocks_.begin(), blocks_.end(), is_finite)) return false;
  if (!std::all_of(points_.begin(), points_.end(), is_finite)) return false;
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    readBlock(blocks_.data() + i * kBatchPoseBlock<kDim>, graph.poses[i].T_world_vertex);
  }
  for (std::size_t i = 0; i < graph.points.size(); ++i) {
    std::copy_n(points_.data() + i * kDim, kDim, graph.points[i].position_m.data());
  }
  return true;
}

template class BatchProblem<2>;
template class BatchProblem<3>;

}  // namespace semantic_mht_slam
