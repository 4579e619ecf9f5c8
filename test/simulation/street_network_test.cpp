#include "semantic_mht_slam/simulation/street_network.h"

#include <algorithm>
#include <map>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(StreetNetworkTest, EveryCornerHasTwoStreetsAndAllAreConnected) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    StreetNetworkConfig config;
    config.removed_street_prob = 0.8;
    const StreetNetwork network = buildStreetNetwork(config, Rng(seed));
    std::map<int, int> degree;
    std::vector<int> part(network.nodes_m.size());
    for (std::size_t i = 0; i < part.size(); ++i) part[i] = static_cast<int>(i);
    for (const Street& street : network.streets) {
      ++degree[street.from];
      ++degree[street.to];
      const int from = part[static_cast<std::size_t>(street.from)];
      const int to = part[static_cast<std::size_t>(street.to)];
      std::replace(part.begin(), part.end(), from, to);
    }
    for (std::size_t node = 0; node < part.size(); ++node) {
      EXPECT_GE(degree[static_cast<int>(node)], 2) << "seed " << seed;
      EXPECT_EQ(part[node], part[0]) << "seed " << seed;
    }
  }
}

TEST(StreetNetworkTest, RemovalTakesStreetsAway) {
  StreetNetworkConfig config;
  config.removed_street_prob = 0.0;
  const std::size_t full = buildStreetNetwork(config, Rng(1)).streets.size();
  EXPECT_EQ(full, static_cast<std::size_t>(config.rows * (config.columns - 1) + config.columns * (config.rows - 1)));
  config.removed_street_prob = 0.3;
  EXPECT_LT(buildStreetNetwork(config, Rng(1)).streets.size(), full);
}

TEST(StreetNetworkTest, StreetsBeginAndEndAtTheirCorners) {
  const StreetNetwork network = buildStreetNetwork({}, Rng(3));
  for (const Street& street : network.streets) {
    EXPECT_EQ(street.center_line_m.front(), network.nodes_m[static_cast<std::size_t>(street.from)]);
    EXPECT_LT((street.center_line_m.back() - network.nodes_m[static_cast<std::size_t>(street.to)]).norm(), 1e-9);
    EXPECT_LT((pointOnStreet(street, -1.0).position_m - street.center_line_m.front()).norm(), 1e-9);
    EXPECT_LT((pointOnStreet(street, 1e4).position_m - street.center_line_m.back()).norm(), 1e-9);
  }
}

TEST(StreetNetworkTest, APointOnAStreetIsAsFarAlongAsAskedFor) {
  const StreetNetwork network = buildStreetNetwork({}, Rng(3));
  for (const Street& street : network.streets) {
    double sum = 0.0;
    for (int step = 0; 0.01 * (step + 1) <= street.length_m; ++step) {
      const double along = 0.01 * step;
      sum += (pointOnStreet(street, along + 0.01).position_m - pointOnStreet(street, along).position_m).norm();
    }
    EXPECT_NEAR(sum, street.length_m, 0.05);
  }
}

TEST(StreetNetworkTest, LookalikesAreParallelNeighboursOfTheSameType) {
  StreetNetworkConfig config;
  config.lookalike_prob = 0.7;
  const StreetNetwork network = buildStreetNetwork(config, Rng(5));
  int count = 0;
  for (const Street& street : network.streets) {
    if (street.lookalike_of < 0) continue;
    ++count;
    const Street& model = network.streets[static_cast<std::size_t>(street.lookalike_of)];
    const Eigen::Vector2d direction = (street.center_line_m.back() - street.center_line_m.front()).normalized();
    const Eigen::Vector2d model_direction = (model.center_line_m.back() - model.center_line_m.front()).normalized();
    EXPECT_EQ(street.type, model.type);
    EXPECT_GT(direction.dot(model_direction), 0.9);
    EXPECT_LT((street.center_line_m.front() - model.center_line_m.front()).norm(), 1.7 * config.block_width_m);
  }
  EXPECT_GT(count, static_cast<int>(network.streets.size()) / 3);
  config.lookalike_prob = 0.0;
  for (const Street& street : buildStreetNetwork(config, Rng(5)).streets) EXPECT_EQ(street.lookalike_of, -1);
}

TEST(TerrainTest, GradientIsTheDerivativeOfTheHeight) {
  StreetNetworkConfig config;
  config.hill_height_m = 10.0;
  const Terrain terrain = buildStreetNetwork(config, Rng(2)).terrain;
  Rng rng(1);
  for (int i = 0; i < 50; ++i) {
    const Eigen::Vector2d place(rng.uniform(-500.0, 500.0), rng.uniform(-500.0, 500.0));
    const Eigen::Vector2d dx(1e-4, 0.0);
    const Eigen::Vector2d dy(0.0, 1e-4);
    const Eigen::Vector2d numeric((terrain.height(place + dx) - terrain.height(place - dx)) / 2e-4,
                                  (terrain.height(place + dy) - terrain.height(place - dy)) / 2e-4);
    EXPECT_LT((numeric - terrain.gradient(place)).norm(), 1e-6);
    EXPECT_LE(std::abs(terrain.height(place)), config.hill_height_m);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
