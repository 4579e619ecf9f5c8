#include "semantic_mht_slam/perception/clustering.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <stdexcept>

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>

namespace semantic_mht_slam {
namespace {

constexpr int kBits = 21;  // of one coordinate in a voxel's key
constexpr float kLargestCoordinate = 1 << (kBits - 1);

std::uint64_t keyOf(const Eigen::Vector3f& point_m, float voxels_per_m) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const float coordinate = std::floor(point_m[axis] * voxels_per_m);
    if (!(std::abs(coordinate) < kLargestCoordinate)) throw std::invalid_argument("voxelize: a point is out of range");
    const auto shifted = static_cast<std::uint64_t>(coordinate + kLargestCoordinate);
    key = key << kBits | shifted;
  }
  return key;
}

/// Numbers voxels in the order in which they are met; open addressing.
class VoxelIndex {
 public:
  explicit VoxelIndex(std::size_t largest_size) {
    while ((std::size_t{1} << log_size_) < 2 * largest_size) ++log_size_;
    slots_.assign(std::size_t{1} << log_size_, {0, -1});
  }

  /// The number of a voxel; `next` becomes the number of one that was not met before.
  int find(std::uint64_t key, int next) {
    constexpr std::uint64_t kMixing = 0x9E3779B97F4A7C15ULL;  // 2^64 over the golden ratio spreads neighbouring keys
    std::size_t slot = (key * kMixing) >> (64 - log_size_);
    while (slots_[slot].number >= 0 && slots_[slot].key != key) slot = (slot + 1) & (slots_.size() - 1);
    if (slots_[slot].number < 0) slots_[slot] = {key, next};
    return slots_[slot].number;
  }

 private:
  struct Slot {
    std::uint64_t key;
    int number;
  };

  int log_size_ = 4;
  std::vector<Slot> slots_;
};

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

/// Number of the cluster of each voxel.
std::vector<int> clusterVoxels(const std::vector<Eigen::Vector3f>& centroids_m, double tolerance_m) {
  const PclCloud::Ptr cloud(new PclCloud);
  cloud->reserve(centroids_m.size());
  for (const Eigen::Vector3f& centroid : centroids_m) cloud->push_back({centroid.x(), centroid.y(), centroid.z()});
  constexpr bool kSorted = false;
  const pcl::search::KdTree<pcl::PointXYZ>::Ptr tree(new pcl::search::KdTree<pcl::PointXYZ>(kSorted));
  tree->setInputCloud(cloud);
  std::vector<pcl::PointIndices> clusters;
  pcl::extractEuclideanClusters<pcl::PointXYZ>(*cloud, tree, static_cast<float>(tolerance_m), clusters, 1,
                                               std::numeric_limits<int>::max());
  std::vector<int> cluster_of_voxel(centroids_m.size(), 0);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    for (const int voxel : clusters[i].indices) cluster_of_voxel[static_cast<std::size_t>(voxel)] = static_cast<int>(i);
  }
  return cluster_of_voxel;
}

}  // namespace

VoxelGrid voxelize(const std::vector<Eigen::Vector3f>& points_m, double voxel_m) {
  VoxelGrid grid;
  grid.voxel_of_point.reserve(points_m.size());
  VoxelIndex index(points_m.size());
  std::vector<int> counts;
  const auto voxels_per_m = static_cast<float>(1.0 / voxel_m);
  for (const Eigen::Vector3f& point : points_m) {
    const int next = static_cast<int>(counts.size());
    const int voxel = index.find(keyOf(point, voxels_per_m), next);
    if (voxel == next) {
      counts.push_back(0);
      grid.centroids_m.emplace_back(Eigen::Vector3f::Zero());
    }
    ++counts[static_cast<std::size_t>(voxel)];
    grid.centroids_m[static_cast<std::size_t>(voxel)] += point;
    grid.voxel_of_point.push_back(voxel);
  }
  for (std::size_t i = 0; i < counts.size(); ++i) grid.centroids_m[i] /= static_cast<float>(counts[i]);
  return grid;
}

std::vector<Cluster> euclideanClusters(const std::vector<Eigen::Vector3f>& points_m, double tolerance_m,
                                       double voxel_m) {
  if (points_m.empty()) return {};
  const VoxelGrid grid = voxelize(points_m, voxel_m);
  const std::vector<int> cluster_of_voxel = clusterVoxels(grid.centroids_m, tolerance_m);
  std::vector<Cluster> clusters;
  std::vector<int> number_of(grid.centroids_m.size(), -1);  // in the order of the first points
  for (std::size_t i = 0; i < points_m.size(); ++i) {
    const int found = cluster_of_voxel[static_cast<std::size_t>(grid.voxel_of_point[i])];
    int& number = number_of[static_cast<std::size_t>(found)];
    if (number < 0) {
      number = static_cast<int>(clusters.size());
      clusters.emplace_back();
    }
    clusters[static_cast<std::size_t>(number)].push_back(static_cast<int>(i));
  }
  return clusters;
}

}  // namespace semantic_mht_slam
