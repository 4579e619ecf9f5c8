#include "semantic_mht_slam/graph/initial_guess.h"

#include <algorithm>
#include <deque>
#include <numeric>

#include "semantic_mht_slam/common/dense_solvers.h"

#include "pose_block.h"

namespace semantic_mht_slam {
namespace {

/// Neighbours of every pose as (other pose, index into `pose_edges`), odometry first.
template <int kDim>
std::vector<std::vector<std::pair<int, int>>> neighbours(const BatchGraph<kDim>& graph) {
  std::vector<std::vector<std::pair<int, int>>> result(graph.poses.size());
  for (const bool odometry : {true, false}) {
    for (int i = 0; i < graph.edgeCount(); ++i) {
      const auto& edge = graph.pose_edges[i];
      if (isOdometry(edge) != odometry) continue;
      result[edge.from].emplace_back(edge.to, i);
      result[edge.to].emplace_back(edge.from, i);
    }
  }
  return result;
}

/// What is wrong with a measurement, or null.
template <class Information>
const char* defectOf(bool is_finite, const Information& information) {
  if (!is_finite || !information.allFinite()) return " is not finite";
  // An unchecked Cholesky decomposition would silently optimise nonsense.
  if (!choleskyOf(information)) return " has an information matrix that is not positive definite";
  return nullptr;
}

template <int kDim>
std::optional<std::string> findBadNumber(const BatchGraph<kDim>& graph) {
  for (const auto& pose : graph.poses) {
    if (pose.has_estimate && !pose.T_world_vertex.isValid()) {
      return "the estimate of pose " + std::to_string(pose.id) + " is not finite";
    }
  }
  for (const auto& edge : graph.pose_edges) {
    if (const char* defect = defectOf(edge.T_from_to.isValid(), edge.information)) {
      return "the edge " + std::to_string(graph.poses[edge.from].id) + " -> " +
             std::to_string(graph.poses[edge.to].id) + defect;
    }
  }
  for (const auto& edge : graph.point_edges) {
    if (const char* defect = defectOf(edge.position_m.allFinite(), edge.information)) {
      return "the edge from pose " + std::to_string(graph.poses[edge.pose].id) + " to point " +
             std::to_string(graph.points[edge.point].id) + defect;
    }
  }
  return std::nullopt;
}

template <int kDim>
std::optional<std::string> findBadIndex(const BatchGraph<kDim>& graph) {
  const int poses = graph.poseCount();
  const int points = graph.pointCount();
  if (poses == 0) return "the graph has no pose";
  const auto outside = [](int index, int size) { return index < 0 || index >= size; };
  for (const auto& edge : graph.pose_edges) {
    if (outside(edge.from, poses) || outside(edge.to, poses)) return "an edge joins a pose that does not exist";
  }
  for (const auto& edge : graph.point_edges) {
    if (outside(edge.pose, poses) || outside(edge.point, points)) return "an edge joins a point that does not exist";
  }
  for (const int index : graph.fixed_poses) {
    if (outside(index, poses)) return "a held pose does not exist";
  }
  return std::nullopt;
}

/// Root of a disjoint-set forest, with path halving.
int findRoot(std::vector<int>& parents, int node) {
  while (parents[node] != node) node = parents[node] = parents[parents[node]];
  return node;
}

/// Points do not count as a connection between poses: one point leaves their rotation free.
template <int kDim>
std::optional<std::string> findDisconnection(const BatchGraph<kDim>& graph) {
  std::vector<int> parents(graph.poses.size());
  std::iota(parents.begin(), parents.end(), 0);
  for (const auto& edge : graph.pose_edges) parents[findRoot(parents, edge.from)] = findRoot(parents, edge.to);
  std::vector<bool> held(parents.size(), false);
  held[findRoot(parents, 0)] = graph.fixed_poses.empty();
  for (const int index : graph.fixed_poses) held[findRoot(parents, index)] = true;
  for (int i = 0; i < graph.poseCount(); ++i) {
    if (!held[findRoot(parents, i)]) {
      return "pose " + std::to_string(graph.poses[i].id) + " is not connected to a held pose";
    }
  }
  std::vector<bool> seen(graph.points.size(), false);
  for (const auto& edge : graph.point_edges) seen[edge.point] = true;
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (!seen[i]) return "point " + std::to_string(graph.points[i].id) + " is never seen";
  }
  return std::nullopt;
}

}  // namespace

template <int kDim>
std::optional<std::string> findDefect(const BatchGraph<kDim>& graph) {
  if (auto defect = findBadIndex(graph)) return defect;
  if (auto defect = findBadNumber(graph)) return defect;
  return findDisconnection(graph);
}

template <int kDim>
void fillMissingEstimates(BatchGraph<kDim>& graph) {
  const auto next_to = neighbours(graph);
  std::deque<int> queue;
  for (int i = 0; i < graph.poseCount(); ++i) {
    if (graph.poses[i].has_estimate) queue.push_back(i);
  }
  if (queue.empty()) {
    queue.push_back(graph.fixed_poses.empty() ? 0 : graph.fixed_poses.front());
    graph.poses[queue.front()].has_estimate = true;
  }
  // Odometry is followed to its end before any other edge is used.
  while (!queue.empty()) {
    const int at = queue.front();
    queue.pop_front();
    for (const auto& [other, index] : next_to[at]) {
      if (graph.poses[other].has_estimate) continue;
      const auto& edge = graph.pose_edges[index];
      const auto T_at_other = edge.from == at ? edge.T_from_to : edge.T_from_to.inverse();
      graph.poses[other].T_world_vertex = graph.poses[at].T_world_vertex * T_at_other;
      graph.poses[other].has_estimate = true;
      if (isOdometry(edge)) {
        queue.push_front(at);
        queue.push_front(other);
        break;
      }
      queue.push_back(other);
    }
  }
  for (const auto& edge : graph.point_edges) {
    auto& point = graph.points[edge.point];
    if (point.has_estimate) continue;
    point.position_m = graph.poses[edge.pose].T_world_vertex * edge.position_m;
    point.has_estimate = true;
  }
}

template <int kDim>
double cost(const BatchGraph<kDim>& graph) {
  double sum = 0.0;
  for (const auto& edge : graph.pose_edges) {
    const auto error =
        edgeError(graph.poses[edge.from].T_world_vertex, graph.poses[edge.to].T_world_vertex, edge.T_from_to);
    sum += 0.5 * error.dot(edge.information * error);
  }
  for (const auto& edge : graph.point_edges) {
    const auto T_vertex_world = graph.poses[edge.pose].T_world_vertex.inverse();
    const typename BatchGraph<kDim>::Point error =
        T_vertex_world * graph.points[edge.point].position_m - edge.position_m;
    sum += 0.5 * error.dot(edge.information * error);
  }
  return sum;
}

template std::optional<std::string> findDefect<2>(const BatchGraph<2>&);
template std::optional<std::string> findDefect<3>(const BatchGraph<3>&);
template void fillMissingEstimates<2>(BatchGraph<2>&);
template void fillMissingEstimates<3>(BatchGraph<3>&);
template double cost<2>(const BatchGraph<2>&);
template double cost<3>(const BatchGraph<3>&);

}  // namespace semantic_mht_slam
