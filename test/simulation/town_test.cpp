#include "semantic_mht_slam/simulation/town.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "scenario_files.h"

namespace semantic_mht_slam {
namespace {

double distanceToStreets(const StreetNetwork& network, const Eigen::Vector2d& place) {
  double best = std::numeric_limits<double>::infinity();
  for (const Street& street : network.streets) {
    for (const Eigen::Vector2d& point : street.center_line_m) best = std::min(best, (point - place).norm());
  }
  return best;
}

/// Street coordinates (along, offset) of an object, by search.
Eigen::Vector2d streetCoordinates(const Street& street, const Eigen::Vector2d& place) {
  Eigen::Vector2d best(0.0, std::numeric_limits<double>::infinity());
  for (int step = 0; 0.25 * step <= street.length_m; ++step) {
    const double along = 0.25 * step;
    const StreetPoint point = pointOnStreet(street, along);
    const double offset = (place - point.position_m).norm();
    if (offset >= std::abs(best.y())) continue;
    best = {along, leftOf(point.direction).dot(place - point.position_m) > 0.0 ? offset : -offset};
  }
  return best;
}

/// Share of the objects at `street` that have one of their class at the same place of `other`.
double sharedObjects(const Town& town, int street, int other) {
  int total = 0;
  int shared = 0;
  for (const TownObject& a : town.objects) {
    if (a.street != street) continue;
    ++total;
    const Eigen::Vector2d at =
        streetCoordinates(town.network.streets[static_cast<std::size_t>(street)], a.position_m.head<2>());
    shared += std::any_of(town.objects.begin(), town.objects.end(), [&](const TownObject& b) {
      if (b.street != other || b.town_class != a.town_class) return false;
      const Street& line = town.network.streets[static_cast<std::size_t>(other)];
      return (streetCoordinates(line, b.position_m.head<2>()) - at).norm() < 2.0;
    });
  }
  return total == 0 ? 0.0 : static_cast<double>(shared) / total;
}

/// Mean of sharedObjects over streets and their look-alikes, or their parallel neighbours where there are none.
double meanSharedObjects(const Town& town, bool lookalikes) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < town.network.streets.size(); ++i) {
    const int other = town.network.streets[i].lookalike_of;
    if (lookalikes && other < 0) continue;
    sum += sharedObjects(town, static_cast<int>(i), lookalikes ? other : static_cast<int>(i == 0 ? 1 : i - 1));
    ++count;
  }
  return sum / count;
}

TEST(TownTest, NothingStandsOnARoadway) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    const Town town = buildTown({}, Rng(seed));
    for (const TownObject& object : town.objects) {
      const double half_depth = 0.5 * object.depth_m;
      const double distance = distanceToStreets(town.network, object.position_m.head<2>());
      EXPECT_GT(distance - half_depth, 2.5) << kTownClassNames[static_cast<std::size_t>(object.town_class)];
    }
  }
}

TEST(TownTest, NothingStandsInABuilding) {
  Scenario scenario = shippedScenario("short");  // small blocks, where the yards of two streets meet
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const Town town = buildTown(scenario, Rng(seed));
    for (const TownObject& house : town.objects) {
      if (house.town_class != TownClass::kBuilding) continue;
      for (const TownObject& object : town.objects) {
        if (&object == &house) continue;
        const Eigen::Vector2d offset = (object.position_m - house.position_m).head<2>();
        const double along = std::abs(offset.dot(house.direction)) - 0.5 * house.length_m;
        const double across = std::abs(offset.dot(leftOf(house.direction))) - 0.5 * house.depth_m;
        EXPECT_GT(std::max(along, across), -0.2) << kTownClassNames[static_cast<std::size_t>(object.town_class)];
      }
    }
  }
}

TEST(TownTest, ThingsStandAtTheirHeightAboveTheGround) {
  const Scenario scenario;
  const Town town = buildTown(scenario, Rng(1));
  double sum = 0.0;
  int poles = 0;
  for (const TownObject& object : town.objects) {
    if (object.town_class != TownClass::kPole) continue;
    sum += object.position_m.z() - town.network.terrain.height(object.position_m.head<2>());
    ++poles;
  }
  ASSERT_GT(poles, 100);
  const TownClassConfig& config = scenario.classes[TownClass::kPole];
  EXPECT_NEAR(sum / poles, config.height_m, 4.0 * config.height_stddev_m / std::sqrt(poles));
}

TEST(TownTest, DensityFollowsTheTypeOfStreet) {
  Scenario scenario;
  scenario.network.main_road_every = 0;
  scenario.network.green_prob = 0.5;
  const Town town = buildTown(scenario, Rng(1));
  std::array<double, 3> length = {0.0, 0.0, 0.0};
  std::array<double, 3> trees = {0.0, 0.0, 0.0};
  for (const Street& street : town.network.streets) length[static_cast<std::size_t>(street.type)] += street.length_m;
  for (const TownObject& object : town.objects) {
    if (object.town_class != TownClass::kTrunk) continue;
    trees[static_cast<std::size_t>(town.network.streets[static_cast<std::size_t>(object.street)].type)] += 1.0;
  }
  const TownClassConfig& config = scenario.classes[TownClass::kTrunk];
  // corners stay free, so that fewer find their place than asked for
  EXPECT_NEAR(100.0 * trees[0] / length[0], 0.85 * config.residential_density, 0.15 * config.residential_density);
  EXPECT_NEAR(100.0 * trees[2] / length[2], 0.85 * config.green_density, 0.15 * config.green_density);
}

TEST(TownTest, DoesNotDependOnTheDetectorOrTheRoute) {
  Scenario scenario;
  const Town before = buildTown(scenario, Rng(1));
  scenario.detector.clutter_mean = 5.0;
  scenario.route.length_m = 500.0;
  scenario.classes[TownClass::kPole].range_stddev_m = 1.0;
  const Town after = buildTown(scenario, Rng(1));
  ASSERT_EQ(before.objects.size(), after.objects.size());
  for (std::size_t i = 0; i < before.objects.size(); ++i) {
    EXPECT_EQ(before.objects[i].position_m, after.objects[i].position_m);
  }
}

TEST(TownTest, ParallelStreetsScenarioHasStreetsThatLookAlike) {
  const Town alike = buildTown(shippedScenario("parallel_streets"), Rng(1));
  EXPECT_GT(meanSharedObjects(alike, true), 0.85);
  const Town other = buildTown(shippedScenario("town"), Rng(1));
  EXPECT_LT(meanSharedObjects(other, false), 0.35);
}

TEST(VisibleCentroidTest, LiesOnTheFaceTurnedToTheSensor) {
  TownObject wall;
  wall.position_m = {10.0, 20.0, 0.0};
  wall.length_m = 12.0;
  wall.depth_m = 8.0;
  const Eigen::Vector2d seen = visibleCentroid(wall, {10.0, 0.0});
  EXPECT_NEAR(seen.x(), 10.0, 1e-9);
  EXPECT_NEAR(seen.y(), 16.0, 1e-9);
}

TEST(VisibleCentroidTest, MovesAlongAnObjectWithTheSensor) {
  TownObject wall;
  wall.length_m = 16.0;
  wall.depth_m = 0.2;
  double before = -8.0;
  for (int x = -30; x <= 30; x += 5) {
    const double seen = visibleCentroid(wall, {static_cast<double>(x), -8.0}).x();
    EXPECT_LE(std::abs(seen), 8.0);
    EXPECT_TRUE(std::abs(x) >= 10 || seen > before) << "at " << x;
    before = seen;
  }
}

TEST(VisibleCentroidTest, FromInsideIsTheCentre) {
  TownObject house;
  house.position_m = {1.0, 2.0, 3.0};
  house.length_m = house.depth_m = 10.0;
  EXPECT_EQ(visibleCentroid(house, {1.5, 2.5}), Eigen::Vector2d(1.0, 2.0));
}

}  // namespace
}  // namespace semantic_mht_slam
