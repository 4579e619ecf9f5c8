#include "semantic_mht_slam/simulation/route.h"

#include <algorithm>
#include <array>
#include <set>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

int nodeAt(const StreetNetwork& network, const Leg& leg, bool end) {
  const Street& street = network.streets[static_cast<std::size_t>(leg.street)];
  return leg.reversed == end ? street.from : street.to;
}

/// Shares of length: driven for the first time, again in the same direction, in the opposite direction only.
std::array<double, 3> sharesOf(const StreetNetwork& network, const std::vector<Leg>& legs) {
  std::array<double, 3> length = {0.0, 0.0, 0.0};
  std::set<std::pair<int, bool>> driven;
  double total = 0.0;
  for (const Leg& leg : legs) {
    const bool same = driven.count({leg.street, leg.reversed}) > 0;
    const bool opposite = driven.count({leg.street, !leg.reversed}) > 0;
    const double street = network.streets[static_cast<std::size_t>(leg.street)].length_m;
    length[same ? 1 : opposite ? 2 : 0] += street;
    total += street;
    driven.insert({leg.street, leg.reversed});
  }
  for (double& share : length) share /= total;
  return length;
}

std::string errorOf(const StreetNetwork& network, const RouteConfig& config) {
  try {
    planRoute(network, config, config.length_m, Rng(1));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RouteTest, IsConnectedLongEnoughAndNeverTurnsOnAStreet) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const StreetNetwork network = buildStreetNetwork({}, Rng(seed));
    const std::vector<Leg> legs = planRoute(network, {}, 3000.0, Rng(seed));
    double length = network.streets[static_cast<std::size_t>(legs[0].street)].length_m;
    for (std::size_t i = 1; i < legs.size(); ++i) {
      EXPECT_EQ(nodeAt(network, legs[i - 1], true), nodeAt(network, legs[i], false));
      EXPECT_NE(legs[i - 1].street, legs[i].street);
      length += network.streets[static_cast<std::size_t>(legs[i].street)].length_m;
    }
    EXPECT_GE(length, 3000.0);
  }
}

TEST(RouteTest, KeepsTheSharesOfRevisitedStreets) {
  RouteConfig config;
  std::array<double, 3> mean = {0.0, 0.0, 0.0};
  const int seeds = 20;
  for (std::uint64_t seed = 0; seed < seeds; ++seed) {
    const StreetNetwork network = buildStreetNetwork({}, Rng(seed));
    const auto shares = sharesOf(network, planRoute(network, config, 3000.0, Rng(seed)));
    for (std::size_t i = 0; i < 3; ++i) mean[i] += shares[i] / seeds;
    EXPECT_GT(shares[1], 0.05) << "seed " << seed;
    EXPECT_GT(shares[2], 0.04) << "seed " << seed;
  }
  EXPECT_NEAR(mean[1], config.same_direction_fraction, 0.05);
  EXPECT_NEAR(mean[2], config.opposite_direction_fraction, 0.05);
}

TEST(RouteTest, WithoutRevisitsWantedDrivesHardlyAStreetTwice) {
  RouteConfig config;
  config.same_direction_fraction = 0.0;
  config.opposite_direction_fraction = 0.0;
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const StreetNetwork network = buildStreetNetwork({}, Rng(seed));
    EXPECT_GT(sharesOf(network, planRoute(network, config, 1500.0, Rng(seed)))[0], 0.9) << "seed " << seed;
  }
}

TEST(RouteTest, TooLongForTheNetworkIsAnErrorThatNamesTheField) {
  const StreetNetwork network = buildStreetNetwork({}, Rng(1));
  RouteConfig config;
  config.length_m = 100000.0;
  EXPECT_NE(errorOf(network, config).find("route.length"), std::string::npos) << errorOf(network, config);
}

TEST(RouteTest, RoundsRepeatTheSameStreetsAndStayConnected) {
  RouteConfig config;
  config.length_m = 20000.0;  // longer than all streets
  config.round_m = 1500.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const StreetNetwork network = buildStreetNetwork({}, Rng(seed));
    const std::vector<Leg> legs = planRoute(network, config, config.length_m, Rng(seed));
    const std::vector<Leg> first = planRoute(network, {}, config.round_m, Rng(seed));
    ASSERT_TRUE(std::equal(first.begin(), first.end(), legs.begin())) << "the first round is a drive of its own";
    const auto again = std::search(legs.begin() + 1, legs.end(), first.begin(), first.end());
    ASSERT_NE(again, legs.end());
    const auto round = static_cast<std::size_t>(again - legs.begin());
    for (std::size_t i = round; i < legs.size(); ++i) EXPECT_EQ(legs[i], legs[i - round]) << "seed " << seed;
    for (std::size_t i = 1; i < legs.size(); ++i) {
      EXPECT_EQ(nodeAt(network, legs[i - 1], true), nodeAt(network, legs[i], false));
      EXPECT_NE(legs[i - 1].street, legs[i].street);
    }
  }
}

TEST(RouteTest, NoWayToTurnRoundIsAnErrorThatNamesTheField) {
  StreetNetworkConfig block;
  block.columns = 2;
  block.rows = 2;
  const StreetNetwork network = buildStreetNetwork(block, Rng(1));
  RouteConfig config;
  config.length_m = 3000.0;
  config.same_direction_fraction = 0.0;
  config.opposite_direction_fraction = 0.9;
  EXPECT_NE(errorOf(network, config).find("route.opposite_direction_fraction"), std::string::npos)
      << errorOf(network, config);
}

}  // namespace
}  // namespace semantic_mht_slam
