#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/graph/pose2.h"

namespace semantic_mht_slam {

/// A pose graph as benchmark files hold it: poses, point landmarks and relative measurements between them, in the plane
/// (kDim 2) or in space (kDim 3). The cost of an estimate is F = 1/2 sum e^T Omega e over all edges with
///   e_t = R_ij^T (R_i^T (t_j - t_i) - t_ij),  e_r = wrapped heading difference (2D) or 2 vec(q) with w >= 0 (3D)
/// and for points e = R_i^T (p - t_i) - p_ij. The order of e is translation, rotation.
template <int kDim>
struct BatchGraph {
  static_assert(kDim == 2 || kDim == 3, "poses of the plane or of space");
  static constexpr int kDof = kDim == 2 ? 3 : 6;
  using PoseType = std::conditional_t<kDim == 2, Pose2, Pose>;
  using Point = Eigen::Matrix<double, kDim, 1>;
  using PoseInformation = Eigen::Matrix<double, kDof, kDof>;
  using PointInformation = Eigen::Matrix<double, kDim, kDim>;

  struct PoseVertex {
    std::int64_t id = 0;
    PoseType T_world_vertex;
    bool has_estimate = false;  ///< false: the pose is filled in from the measurements
  };
  struct PointVertex {
    std::int64_t id = 0;
    Point position_m = Point::Zero();
    bool has_estimate = false;
  };
  struct PoseEdge {
    int from = 0;  ///< index into `poses`
    int to = 0;    ///< index into `poses`
    PoseType T_from_to;
    PoseInformation information = PoseInformation::Identity();
  };
  struct PointEdge {
    int pose = 0;                      ///< index into `poses`
    int point = 0;                     ///< index into `points`
    Point position_m = Point::Zero();  ///< in the frame of the pose
    PointInformation information = PointInformation::Identity();
  };

  std::vector<PoseVertex> poses;    ///< ascending id
  std::vector<PointVertex> points;  ///< ascending id
  std::vector<PoseEdge> pose_edges;
  std::vector<PointEdge> point_edges;
  std::vector<int> fixed_poses;  ///< indices; empty: the first pose is held

  int poseCount() const { return static_cast<int>(poses.size()); }
  int pointCount() const { return static_cast<int>(points.size()); }
  int edgeCount() const { return static_cast<int>(pose_edges.size()); }
};

/// True for edges that join a pose to its successor in `poses`: odometry, which is never doubted.
template <class Edge>
bool isOdometry(const Edge& edge) {
  return edge.to == edge.from + 1;
}

}  // namespace semantic_mht_slam
