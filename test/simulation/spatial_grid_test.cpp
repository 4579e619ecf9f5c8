#include "semantic_mht_slam/simulation/spatial_grid.h"

#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

TEST(SpatialGridTest, EqualsBruteForce) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    std::vector<Eigen::Vector2d> points;
    points.reserve(200);
    for (int i = 0; i < 200; ++i) points.emplace_back(rng.uniform(-50.0, 50.0), rng.uniform(-20.0, 80.0));
    const SpatialGrid grid(points, rng.uniform(1.0, 30.0));
    for (int query = 0; query < 20; ++query) {
      const Eigen::Vector2d center(rng.uniform(-90.0, 90.0), rng.uniform(-90.0, 90.0));
      const double radius = rng.uniform(0.0, 40.0);
      std::vector<int> expected;
      for (std::size_t i = 0; i < points.size(); ++i) {
        if ((points[i] - center).norm() <= radius) expected.push_back(static_cast<int>(i));
      }
      EXPECT_EQ(grid.near(center, radius), expected);
    }
  }
}

TEST(SpatialGridTest, OfNoPointsFindsNothing) {
  EXPECT_TRUE(SpatialGrid({}, 1.0).near({3.0, 4.0}, 100.0).empty());
}

TEST(SpatialGridTest, RefusesACellWithoutSize) {
  EXPECT_THROW(SpatialGrid({}, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
