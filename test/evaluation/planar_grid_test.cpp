#include "semantic_mht_slam/evaluation/planar_grid.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

std::vector<Eigen::Vector2d> randomPoints(unsigned seed, int count) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> coordinate(-20.0, 20.0);
  std::vector<Eigen::Vector2d> points;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(engine);
    points.emplace_back(x, coordinate(engine));
  }
  points.emplace_back(0.0, 0.0);
  points.emplace_back(3.0, 0.0);  // exactly one cell away
  points.emplace_back(-3.0, -6.0);
  return points;
}

class PlanarGridTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(PlanarGridTest, FindsTheNeighboursThatBruteForceFinds) {
  const std::vector<Eigen::Vector2d> points = randomPoints(GetParam(), 300);
  const PlanarGrid grid(points, 3.0);
  for (const Eigen::Vector2d& center : points) {
    std::multiset<std::size_t> found;
    grid.anyNear(center, [&](std::size_t index) {
      if ((points[index] - center).norm() <= 3.0) found.insert(index);
      return false;
    });
    std::multiset<std::size_t> expected;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if ((points[i] - center).norm() <= 3.0) expected.insert(i);
    }
    EXPECT_EQ(found, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlanarGridTest, ::testing::Range(0U, 10U));

TEST(PlanarGridTest, StopsAtTheFirstHit) {
  const PlanarGrid grid({{0.0, 0.0}, {0.1, 0.0}, {0.2, 0.0}}, 1.0);
  int visited = 0;
  EXPECT_TRUE(grid.anyNear({0.0, 0.0}, [&](std::size_t) { return ++visited == 2; }));
  EXPECT_EQ(visited, 2);
  EXPECT_FALSE(grid.anyNear({50.0, 0.0}, [](std::size_t) { return true; }));
}

TEST(PlanarGridTest, RefusesWhatHasNoCell) {
  EXPECT_THROW(PlanarGrid({{0.0, 0.0}}, 0.0), std::invalid_argument);
  EXPECT_THROW(PlanarGrid({{0.0, 0.0}}, std::nan("")), std::invalid_argument);
  EXPECT_THROW(PlanarGrid({{std::nan(""), 0.0}}, 1.0), std::invalid_argument);
  EXPECT_THROW(PlanarGrid({{0.0, 1e300}}, 1.0), std::invalid_argument);
  EXPECT_THROW(PlanarGrid({{0.0, std::numeric_limits<double>::infinity()}}, 1.0), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
