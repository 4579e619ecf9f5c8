#pragma once

#include <vector>

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Indices of the points of one cluster, rising.
using Cluster = std::vector<int>;

/// Points grouped by the cubic voxels that they lie in.
struct VoxelGrid {
  std::vector<Eigen::Vector3f> centroids_m;  ///< mean of each voxel's points, in the order of each voxel's first point
  std::vector<int> voxel_of_point;
};

/// Groups points by voxels of edge `voxel_m` that are aligned to the origin. Points must be finite; a coordinate of
/// more than 10^6 voxels throws std::invalid_argument.
VoxelGrid voxelize(const std::vector<Eigen::Vector3f>& points_m, double voxel_m);

/// Euclidean clusters (single linkage, PCL): the centroids of occupied voxels are one cluster if a chain of them with
/// steps of at most `tolerance_m` leads from one to the other; every point goes where its voxel goes. Each cluster in
/// the order of its first point. Points must be finite.
std::vector<Cluster> euclideanClusters(const std::vector<Eigen::Vector3f>& points_m, double tolerance_m,
                                       double voxel_m);

}  // namespace semantic_mht_slam
