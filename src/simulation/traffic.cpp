#include "semantic_mht_slam/simulation/traffic.h"

#include <cmath>

namespace semantic_mht_slam {
namespace {

constexpr double kGapMin_m = 10.0;
constexpr double kGapMax_m = 30.0;

using FramePositions = std::vector<std::vector<Eigen::Vector3d>>;

/// Puts a car on the path, unless it would be beyond the ends.
void addCar(const VehiclePath& path, const Terrain& terrain, double height_m, double along_m, double left_m,
            std::vector<Eigen::Vector3d>& frame) {
  if (along_m < 0.0 || along_m > path.length()) return;
  const StreetPoint point = path.at(along_m);
  const Eigen::Vector2d position = point.position_m + left_m * leftOf(point.direction);
  frame.emplace_back(position.x(), position.y(), terrain.height(position) + height_m);
}

}  // namespace

std::vector<std::vector<Eigen::Vector3d>> simulateTraffic(const VehiclePath& path, const VehicleMotion& motion,
                                                          const Terrain& terrain, const Scenario& scenario, Rng rng) {
  const TrafficConfig& config = scenario.traffic;
  const double period_s = 1.0 / scenario.route.frame_rate_hz;
  const double reach_m = scenario.passes.radius_m;
  const double height_m = scenario.classes[TownClass::kVehicle].height_m;
  const std::size_t frames = motion.along_m.size();
  FramePositions positions(frames);
  for (std::size_t start = 0; start < frames; ++start) {
    Rng frame_rng = rng.fork("frame", start);
    const std::uint64_t oncoming = frame_rng.poisson(config.oncoming_per_minute * period_s / 60.0);
    const std::uint64_t leading = frame_rng.poisson(config.leading_per_minute * period_s / 60.0);
    for (std::uint64_t car = 0; car < oncoming; ++car) {
      double along_m = motion.along_m[start] + reach_m;
      for (std::size_t k = start; k < frames && along_m > motion.along_m[k] - reach_m; ++k) {
        addCar(path, terrain, height_m, along_m, config.lane_width_m, positions[k]);
        along_m -= config.speed_mps * period_s;
      }
    }
    for (std::uint64_t car = 0; car < leading; ++car) {
      const double gap_m = frame_rng.uniform(kGapMin_m, kGapMax_m);
      const double duration_s = -config.leading_duration_s * std::log(1.0 - frame_rng.uniform());
      const std::size_t end = start + static_cast<std::size_t>(duration_s / period_s);
      for (std::size_t k = start; k < frames && k < end; ++k) {
        addCar(path, terrain, height_m, motion.along_m[k] + gap_m, 0.0, positions[k]);
      }
    }
  }
  return positions;
}

}  // namespace semantic_mht_slam
