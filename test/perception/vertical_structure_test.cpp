#include "semantic_mht_slam/perception/vertical_structure.h"

#include <cmath>
#include <numeric>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// Adds a rod of 0.1 m and returns its indices.
Cluster addRod(Points& points, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, int count, Rng& rng) {
  Cluster cluster;
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d noise(rng.uniform(-0.05, 0.05), rng.uniform(-0.05, 0.05), 0.0);
    const double share = (i + 0.5) / count;
    cluster.push_back(static_cast<int>(points.size()));
    points.emplace_back((from_m + share * (to_m - from_m) + noise).cast<float>());
  }
  return cluster;
}

Cluster joined(const Cluster& a, const Cluster& b) {
  Cluster both = a;
  both.insert(both.end(), b.begin(), b.end());
  return both;
}

TEST(VerticalStructureTest, TwoPolesInOneClusterAreSplitIntoExactlyTheirPoints) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const double angle = rng.uniform(0.0, 6.28);
    const Eigen::Vector3d foot(rng.uniform(-20.0, 20.0), rng.uniform(-20.0, 20.0), -1.7);
    const Eigen::Vector3d step(0.65 * std::cos(angle), 0.65 * std::sin(angle), 0.0);
    Points points;
    const Cluster left = addRod(points, foot, foot + Eigen::Vector3d(0, 0, 2.5), 40, rng);
    const Cluster right = addRod(points, foot + step, foot + step + Eigen::Vector3d(0, 0, 2.2), 40, rng);
    const std::vector<Cluster> parts = splitByAxes(points, joined(left, right), {});
    ASSERT_EQ(parts.size(), 2U) << "seed " << seed;
    EXPECT_TRUE((parts[0] == left && parts[1] == right) || (parts[0] == right && parts[1] == left)) << "seed " << seed;
  }
}

TEST(VerticalStructureTest, TrunkWithBranchesStaysWhole) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    Points points;
    Cluster tree = addRod(points, {5.0, 5.0, -1.7}, {5.0, 5.0, 0.8}, 100, rng);
    for (int branch = 0; branch < 4; ++branch) {
      const double angle = rng.uniform(0.0, 6.28);
      tree = joined(tree, addRod(points, {5.0, 5.0, 0.2},
                                 {5.0 + 1.5 * std::cos(angle), 5.0 + 1.5 * std::sin(angle), 0.8}, 30, rng));
    }
    EXPECT_EQ(splitByAxes(points, tree, {}), std::vector<Cluster>{tree}) << "seed " << seed;
  }
}

TEST(VerticalStructureTest, WideTrunkIsOneAxis) {
  Rng rng(2);
  Points points;
  Cluster trunk;
  for (int i = 0; i < 500; ++i) {  // the near half of a trunk of 1 m
    const double angle = rng.uniform(-1.57, 1.57);
    trunk.push_back(i);
    points.emplace_back(
        Eigen::Vector3d(8.0 - 0.5 * std::cos(angle), 0.5 * std::sin(angle), rng.uniform(-1.7, 0.5)).cast<float>());
  }
  EXPECT_EQ(splitByAxes(points, trunk, {}), std::vector<Cluster>{trunk});
}

TEST(VerticalStructureTest, PiecesOfOnePoleAreMergedAndItsNeighbourIsNot) {
  Rng rng(3);
  Points points;
  const Cluster low = addRod(points, {5.0, 0.0, -1.7}, {5.0, 0.0, -0.6}, 20, rng);
  const Cluster neighbour = addRod(points, {5.0, 0.9, -1.7}, {5.0, 0.9, 1.0}, 30, rng);
  const Cluster middle = addRod(points, {5.0, 0.0, 0.2}, {5.0, 0.0, 0.6}, 10, rng);
  const Cluster top = addRod(points, {5.0, 0.0, 1.3}, {5.0, 0.0, 1.8}, 10, rng);
  const Cluster lamp = addRod(points, {5.0, 0.0, 4.0}, {5.0, 0.0, 4.3}, 10, rng);
  const std::vector<Cluster> merged = mergeByAxes(points, {low, neighbour, middle, top, lamp}, {});
  EXPECT_EQ(merged, (std::vector<Cluster>{joined(joined(low, middle), top), neighbour, lamp}));
}

TEST(VerticalStructureTest, OrderOfPiecesDoesNotChangeWhatIsMerged) {
  Rng rng(4);
  Points points;
  std::vector<Cluster> pieces;
  for (int pole = 0; pole < 10; ++pole) {
    for (int piece = 0; piece < 3; ++piece) {
      pieces.push_back(addRod(points, {5.0 + pole, 2.0, piece - 1.5}, {5.0 + pole, 2.0, piece - 1.0}, 8, rng));
    }
  }
  for (int round = 0; round < 10; ++round) {
    for (std::size_t i = pieces.size(); i > 1; --i) std::swap(pieces[i - 1], pieces[rng.index(i)]);
    const std::vector<Cluster> merged = mergeByAxes(points, pieces, {});
    ASSERT_EQ(merged.size(), 10U);
    for (const Cluster& pole : merged) {
      ASSERT_EQ(pole.size(), 24U);
      Cluster expected(24);
      std::iota(expected.begin(), expected.end(), pole.front());
      EXPECT_EQ(pole, expected);
    }
  }
}

}  // namespace
}  // namespace semantic_mht_slam
