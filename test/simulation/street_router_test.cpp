#include "semantic_mht_slam/simulation/street_router.h"

#include <limits>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

int nodeBefore(const StreetNetwork& network, int id) {
  const Street& street = network.streets[static_cast<std::size_t>(id / 2)];
  return id % 2 == 0 ? street.from : street.to;
}

bool follows(const StreetNetwork& network, int before, int after) {
  return nodeBefore(network, oppositeOf(before)) == nodeBefore(network, after) && after != oppositeOf(before);
}

std::vector<double> randomCosts(int count, Rng& rng) {
  std::vector<double> costs;
  costs.reserve(static_cast<std::size_t>(count));
  for (int id = 0; id < count; ++id) costs.push_back(rng.uniform(1.0, 10.0));
  return costs;
}

/// Costs from the end of `from` by relaxing every pair of streets as often as there are streets (Bellman and Ford).
std::vector<double> bruteForce(const StreetNetwork& network, int from, const std::vector<double>& costs) {
  const int count = static_cast<int>(costs.size());
  std::vector<double> best(costs.size(), std::numeric_limits<double>::infinity());
  for (int id = 0; id < count; ++id) {
    if (follows(network, from, id)) best[static_cast<std::size_t>(id)] = costs[static_cast<std::size_t>(id)];
  }
  for (int round = 0; round < count; ++round) {
    for (int a = 0; a < count; ++a) {
      for (int b = 0; b < count; ++b) {
        if (!follows(network, a, b)) continue;
        const std::size_t to = static_cast<std::size_t>(b);
        best[to] = std::min(best[to], best[static_cast<std::size_t>(a)] + costs[to]);
      }
    }
  }
  return best;
}

TEST(StreetRouterTest, FindsTheCheapestWayWithoutTurning) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    StreetNetworkConfig config;
    config.columns = 4;
    config.rows = 3;
    const StreetNetwork network = buildStreetNetwork(config, Rng(seed));
    const StreetRouter router(network);
    Rng rng(seed);
    const std::vector<double> costs = randomCosts(router.count(), rng);
    const int from = static_cast<int>(rng.index(costs.size()));
    const std::vector<double> best = bruteForce(network, from, costs);
    for (int goal = 0; goal < router.count(); ++goal) {
      const auto way = router.find(from, goal, costs);
      ASSERT_TRUE(way.has_value());
      EXPECT_NEAR(way->cost, best[static_cast<std::size_t>(goal)], 1e-9);
      EXPECT_EQ(way->ids.back(), goal);
      double sum = 0.0;
      int before = from;
      for (const int id : way->ids) {
        EXPECT_TRUE(follows(network, before, id));
        sum += costs[static_cast<std::size_t>(id)];
        before = id;
      }
      EXPECT_NEAR(sum, way->cost, 1e-9);
    }
  }
}

TEST(StreetRouterTest, FindsNoWayRoundInASingleBlock) {
  StreetNetworkConfig config;
  config.columns = 2;
  config.rows = 2;
  const StreetNetwork network = buildStreetNetwork(config, Rng(1));
  const StreetRouter router(network);
  const std::vector<double> costs(static_cast<std::size_t>(router.count()), 1.0);
  EXPECT_TRUE(router.find(0, 0, costs).has_value());
  EXPECT_FALSE(router.find(0, oppositeOf(0), costs).has_value());
}

}  // namespace
}  // namespace semantic_mht_slam
