#include "semantic_mht_slam/perception/clustering.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

using Points = std::vector<Eigen::Vector3f>;

Points randomPoints(Rng& rng, int count, double side_m) {
  Points points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(
        Eigen::Vector3d(rng.uniform(-side_m, side_m), rng.uniform(-side_m, side_m), rng.uniform(-2.0, 2.0))
            .cast<float>());
  }
  return points;
}

/// Single linkage by its definition.
std::vector<Cluster> bruteForce(const Points& points, float tolerance_m) {
  std::vector<int> of(points.size(), -1);
  std::vector<Cluster> clusters;
  for (std::size_t seed = 0; seed < points.size(); ++seed) {
    if (of[seed] >= 0) continue;
    Cluster cluster = {static_cast<int>(seed)};
    of[seed] = static_cast<int>(clusters.size());
    for (std::size_t next = 0; next < cluster.size(); ++next) {
      for (std::size_t j = 0; j < points.size(); ++j) {
        const auto from = static_cast<std::size_t>(cluster[next]);
        if (of[j] >= 0 || (points[j] - points[from]).norm() > tolerance_m) continue;
        of[j] = of[seed];
        cluster.push_back(static_cast<int>(j));
      }
    }
    std::sort(cluster.begin(), cluster.end());
    clusters.push_back(cluster);
  }
  return clusters;
}

TEST(ClusteringTest, EqualsSingleLinkageByBruteForceWhereEveryPointHasAVoxelOfItsOwn) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const Points points = randomPoints(rng, 300, 6.0);
    EXPECT_EQ(euclideanClusters(points, 0.7, 0.011), bruteForce(points, 0.7F)) << "seed " << seed;
  }
}

TEST(ClusteringTest, EveryPointIsInExactlyOneCluster) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    const Points points = randomPoints(rng, 5000, 10.0);
    Cluster all;
    for (const Cluster& cluster : euclideanClusters(points, 0.4, 0.15)) {
      EXPECT_TRUE(std::is_sorted(cluster.begin(), cluster.end()));
      all.insert(all.end(), cluster.begin(), cluster.end());
    }
    std::sort(all.begin(), all.end());
    Cluster expected(points.size());
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(all, expected) << "seed " << seed;
  }
}

TEST(ClusteringTest, VoxelHoldsExactlyThePointsOfItsCubeAndTheirMean) {
  Rng rng(5);
  const Points points = randomPoints(rng, 2000, 3.0);
  constexpr double kVoxel = 0.5;
  const VoxelGrid grid = voxelize(points, kVoxel);
  const auto cube = [](const Eigen::Vector3f& point) -> Eigen::Vector3f { return (point / 0.5F).array().floor(); };
  std::vector<Eigen::Vector3d> sums(grid.centroids_m.size(), Eigen::Vector3d::Zero());
  std::vector<int> counts(sums.size(), 0);
  std::vector<std::size_t> first(sums.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto voxel = static_cast<std::size_t>(grid.voxel_of_point[i]);
    first[voxel] = std::min(first[voxel], i);
    EXPECT_EQ(cube(points[i]), cube(points[first[voxel]])) << "point " << i;
    sums[voxel] += points[i].cast<double>();
    ++counts[voxel];
  }
  for (std::size_t i = 0; i < sums.size(); ++i) {
    EXPECT_LT((sums[i] / counts[i] - grid.centroids_m[i].cast<double>()).norm(), 1e-5) << "voxel " << i;
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(cube(points[first[i]]), cube(points[first[j]]));
  }
}

TEST(ClusteringTest, NoPointsGiveNoClustersAndUnusablePointsThrow) {
  EXPECT_TRUE(euclideanClusters({}, 0.5, 0.1).empty());
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(euclideanClusters({{nan, 0.0F, 0.0F}}, 0.5, 0.1), std::invalid_argument);
  EXPECT_THROW(euclideanClusters({{1e9F, 0.0F, 0.0F}}, 0.5, 0.1), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
