#include "semantic_mht_slam/simulation/landmark_schedule.h"

#include <cmath>

#include "semantic_mht_slam/simulation/spatial_grid.h"

namespace semantic_mht_slam {
namespace {

/// The same object elsewhere along its street.
TownObject movedAlong(TownObject object, double distance_m) {
  object.position_m.head<2>() += distance_m * object.direction;
  return object;
}

/// The cars of one parking place, in the order of their arrival.
std::vector<ScheduledLandmark> scheduleCars(const TownObject& place, const std::vector<Pass>& passes,
                                            const PassesConfig& config, Rng rng) {
  std::vector<ScheduledLandmark> cars;
  bool taken = false;
  for (std::size_t i = 0; i < passes.size(); ++i) {
    const bool same = i > 0 && rng.bernoulli(config.parking_stay_prob);
    if (!same) {
      taken = rng.bernoulli(config.parking_occupancy_prob);
      if (taken) cars.push_back({movedAlong(place, rng.normal(0.0, config.parking_jitter_m)), {}});
    }
    if (taken) cars.back().passes.push_back(passes[i]);
  }
  return cars;
}

}  // namespace

std::vector<std::vector<Pass>> findPasses(const std::vector<TownObject>& objects, const VehicleMotion& motion,
                                          const PassesConfig& config, double frame_rate_hz) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(objects.size());
  for (const TownObject& object : objects) positions.push_back(object.position_m.head<2>());
  const SpatialGrid grid(positions, config.radius_m);
  const int gap = static_cast<int>(std::lround(config.gap_s * frame_rate_hz));
  std::vector<std::vector<Pass>> passes(objects.size());
  for (int k = 0; k < static_cast<int>(motion.T_world_base.size()); ++k) {
    const Pose& T_world_base = motion.T_world_base[static_cast<std::size_t>(k)];
    for (const int i : grid.near(T_world_base.translation_m.head<2>(), config.radius_m)) {
      std::vector<Pass>& known = passes[static_cast<std::size_t>(i)];
      if (known.empty() || k - known.back().last_frame > std::max(gap, 1)) known.push_back({k, k});
      known.back().last_frame = k;
    }
  }
  return passes;
}

std::vector<ScheduledLandmark> scheduleLandmarks(const Town& town, const VehicleMotion& motion,
                                                 const Scenario& scenario, const Rng& rng) {
  const auto passes = findPasses(town.objects, motion, scenario.passes, scenario.route.frame_rate_hz);
  std::vector<ScheduledLandmark> things;
  std::vector<ScheduledLandmark> cars;
  for (std::size_t i = 0; i < town.objects.size(); ++i) {
    if (passes[i].empty()) continue;
    if (town.objects[i].town_class != TownClass::kVehicle) {
      things.push_back({town.objects[i], passes[i]});
      continue;
    }
    for (ScheduledLandmark& car : scheduleCars(town.objects[i], passes[i], scenario.passes, rng.fork("place", i))) {
      cars.push_back(std::move(car));
    }
  }
  things.insert(things.end(), cars.begin(), cars.end());
  return things;
}

}  // namespace semantic_mht_slam
