#include "semantic_mht_slam/simulation/town.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/simulation/spatial_grid.h"

namespace semantic_mht_slam {
namespace {

constexpr double kCornerClearance_m = 8.0;  // a corner of 8 m radius passes 5 m from the node
constexpr double kOtherStreetClearance_m = 5.0;
constexpr double kObjectClearance_m = 0.3;
constexpr int kPlacementTries = 20;

/// An object in the coordinates of its street.
struct LayoutItem {
  TownClass town_class = TownClass::kPole;
  double along_m = 0.0;
  double offset_m = 0.0;  ///< of the centre, positive on the left
  double height_m = 0.0;  ///< above the ground
  double length_m = 0.0;
  double depth_m = 0.0;
};

/// Buildings first: the small things then find their place around them.
constexpr std::array<TownClass, kTownClassCount> kLayoutOrder = {
    TownClass::kBuilding, TownClass::kFence,       TownClass::kVehicle,   TownClass::kPole,
    TownClass::kTrunk,    TownClass::kTrafficSign, TownClass::kVegetation};

double densityOn(const TownClassConfig& config, StreetType type) {
  if (type == StreetType::kMain) return config.main_density;
  return type == StreetType::kGreen ? config.green_density : config.residential_density;
}

bool overlap(const LayoutItem& a, const LayoutItem& b, double spacing_m) {
  const double along = std::abs(a.along_m - b.along_m) - 0.5 * (a.length_m + b.length_m);
  const double across = std::abs(a.offset_m - b.offset_m) - 0.5 * (a.depth_m + b.depth_m);
  if (a.town_class == b.town_class && a.offset_m * b.offset_m > 0.0 && along < spacing_m) return true;
  return along < kObjectClearance_m && across < kObjectClearance_m;
}

LayoutItem drawItem(TownClass town_class, const TownClassConfig& config, double street_length_m, Rng& rng) {
  LayoutItem item;
  item.town_class = town_class;
  item.length_m = rng.uniform(config.length_min_m, config.length_max_m);
  item.depth_m = config.depth_m;
  item.along_m = rng.uniform(0.0, street_length_m);
  const double side = rng.bernoulli(0.5) ? 1.0 : -1.0;
  item.offset_m = side * (rng.uniform(config.setback_min_m, config.setback_max_m) + 0.5 * config.depth_m);
  item.height_m = std::max(0.0, rng.normal(config.height_m, config.height_stddev_m));
  return item;
}

std::vector<LayoutItem> drawLayout(const Street& street, const TownClassesConfig& classes, Rng rng) {
  std::vector<LayoutItem> items;
  for (const TownClass town_class : kLayoutOrder) {
    const TownClassConfig& config = classes[town_class];
    const double expected = densityOn(config, street.type) * street.length_m / 100.0;
    const int count = static_cast<int>(std::floor(expected + rng.uniform()));
    for (int i = 0; i < count; ++i) {
      for (int attempt = 0; attempt < kPlacementTries; ++attempt) {
        const LayoutItem item = drawItem(town_class, config, street.length_m, rng);
        const auto hits = [&](const LayoutItem& other) { return overlap(item, other, config.spacing_m); };
        if (std::any_of(items.begin(), items.end(), hits)) continue;
        items.push_back(item);
        break;
      }
    }
  }
  return items;
}

std::array<Eigen::Vector2d, 4> cornersOf(const TownObject& object) {
  const Eigen::Vector2d center = object.position_m.head<2>();
  const Eigen::Vector2d along = 0.5 * object.length_m * object.direction;
  const Eigen::Vector2d across = 0.5 * object.depth_m * leftOf(object.direction);
  return {center + along + across, center - along + across, center - along - across, center + along - across};
}

/// Points on the outline of an object, close enough to find what it runs into.
std::vector<Eigen::Vector2d> outlineOf(const TownObject& object) {
  constexpr int kPointsPerSide = 4;
  const std::array<Eigen::Vector2d, 4> corners = cornersOf(object);
  std::vector<Eigen::Vector2d> points;
  for (std::size_t side = 0; side < corners.size(); ++side) {
    const Eigen::Vector2d step = (corners[(side + 1) % 4] - corners[side]) / kPointsPerSide;
    for (int i = 0; i < kPointsPerSide; ++i) points.push_back(corners[side] + i * step);
  }
  return points;
}

bool isInside(const Eigen::Vector2d& point, const TownObject& box) {
  const Eigen::Vector2d offset = point - box.position_m.head<2>();
  return std::abs(offset.dot(box.direction)) < 0.5 * box.length_m &&
         std::abs(offset.dot(leftOf(box.direction))) < 0.5 * box.depth_m;
}

/// True if one of the two is a building and they reach into each other: at corners, in yards and on bent streets, where
/// the coordinates of a street alone do not tell.
bool collide(const TownObject& a, const TownObject& b) {
  if (a.town_class != TownClass::kBuilding && b.town_class != TownClass::kBuilding) return false;
  if ((a.position_m - b.position_m).norm() > a.length_m + a.depth_m + b.length_m + b.depth_m) return false;
  const auto reaches = [](const TownObject& from, const TownObject& into) {
    const std::vector<Eigen::Vector2d> outline = outlineOf(from);
    return std::any_of(outline.begin(), outline.end(), [&](const auto& point) { return isInside(point, into); });
  };
  return reaches(a, b) || reaches(b, a);
}

/// Knows the roadways of the whole network.
class Roadways {
 public:
  explicit Roadways(const StreetNetwork& network) : nodes_(network.nodes_m, 50.0), lines_(collect(network), 20.0) {}

  bool isClear(const TownObject& object) const {
    const std::vector<Eigen::Vector2d> outline = outlineOf(object);
    return std::all_of(outline.begin(), outline.end(),
                       [&](const Eigen::Vector2d& point) { return isClear(point, object.street); });
  }

 private:
  std::vector<Eigen::Vector2d> collect(const StreetNetwork& network) {
    std::vector<Eigen::Vector2d> points;
    for (std::size_t i = 0; i < network.streets.size(); ++i) {
      for (const Eigen::Vector2d& point : network.streets[i].center_line_m) {
        points.push_back(point);
        street_of_point_.push_back(static_cast<int>(i));
      }
    }
    return points;
  }

  bool isClear(const Eigen::Vector2d& point, int own_street) const {
    if (!nodes_.near(point, kCornerClearance_m).empty()) return false;
    const std::vector<int> near = lines_.near(point, kOtherStreetClearance_m);
    return std::all_of(near.begin(), near.end(),
                       [&](int i) { return street_of_point_[static_cast<std::size_t>(i)] == own_street; });
  }

  std::vector<int> street_of_point_;  // filled while lines_ is built
  SpatialGrid nodes_;
  SpatialGrid lines_;
};

TownObject place(const LayoutItem& item, const StreetNetwork& network, int street) {
  const StreetPoint point = pointOnStreet(network.streets[static_cast<std::size_t>(street)], item.along_m);
  const Eigen::Vector2d position = point.position_m + item.offset_m * leftOf(point.direction);
  TownObject object;
  object.town_class = item.town_class;
  object.street = street;
  object.position_m << position, network.terrain.height(position) + item.height_m;
  object.direction = point.direction;
  object.length_m = item.length_m;
  object.depth_m = item.depth_m;
  return object;
}

int originalOf(const StreetNetwork& network, int street) {
  while (network.streets[static_cast<std::size_t>(street)].lookalike_of >= 0) {
    street = network.streets[static_cast<std::size_t>(street)].lookalike_of;
  }
  return street;
}

void addStreetObjects(int street, const Scenario& scenario, const Roadways& roadways, const Rng& rng, Town& town) {
  const int original = originalOf(town.network, street);
  Rng jitter = rng.fork("jitter", static_cast<std::uint64_t>(street));
  const Rng layout_rng = rng.fork("layout", static_cast<std::uint64_t>(original));
  const Street& model = town.network.streets[static_cast<std::size_t>(original)];
  for (LayoutItem item : drawLayout(model, scenario.classes, layout_rng)) {
    if (original != street) {
      item.along_m += jitter.normal(0.0, scenario.network.lookalike_jitter_m);
      item.offset_m += jitter.normal(0.0, scenario.network.lookalike_jitter_m);
    }
    if (item.along_m < 0.0 || item.along_m > town.network.streets[static_cast<std::size_t>(street)].length_m) continue;
    const TownObject object = place(item, town.network, street);
    const auto hits = [&](const TownObject& other) { return collide(object, other); };
    if (!roadways.isClear(object) || std::any_of(town.objects.begin(), town.objects.end(), hits)) continue;
    town.objects.push_back(object);
  }
}

}  // namespace

Town buildTown(const Scenario& scenario, const Rng& rng) {
  Town town;
  town.network = buildStreetNetwork(scenario.network, rng.fork("network"));
  const Roadways roadways(town.network);
  for (std::size_t i = 0; i < town.network.streets.size(); ++i) {
    addStreetObjects(static_cast<int>(i), scenario, roadways, rng.fork("objects"), town);
  }
  return town;
}

Eigen::Vector2d visibleCentroid(const TownObject& object, const Eigen::Vector2d& sensor_m) {
  constexpr int kSamples = 8;  // a face
  const Eigen::Vector2d center = object.position_m.head<2>();
  const std::array<Eigen::Vector2d, 4> corners = cornersOf(object);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weights = 0.0;
  for (std::size_t side = 0; side < corners.size(); ++side) {
    const Eigen::Vector2d edge = corners[(side + 1) % 4] - corners[side];
    const Eigen::Vector2d outward = -leftOf(edge);  // its length is that of the edge, which weights the face
    if (outward.dot(sensor_m - corners[side]) <= 0.0) continue;
    for (int i = 0; i < kSamples; ++i) {
      const Eigen::Vector2d point = corners[side] + (i + 0.5) / kSamples * edge;
      const Eigen::Vector2d to_sensor = sensor_m - point;
      const double range = std::max(1.0, to_sensor.norm());
      const double weight = outward.dot(to_sensor) / (range * range * range);
      sum += weight * point;
      weights += weight;
    }
  }
  return weights > 0.0 ? Eigen::Vector2d(sum / weights) : center;
}

}  // namespace semantic_mht_slam
