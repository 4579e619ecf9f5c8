#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/simulation/scenario.h"
#include "semantic_mht_slam/simulation/vehicle_motion.h"

namespace semantic_mht_slam {

/// Centroids (world frame) of the moving cars near the sensor, one list a frame. Leading cars drive ahead for a while,
/// oncoming cars use the other lane; both follow the path of the sensor.
std::vector<std::vector<Eigen::Vector3d>> simulateTraffic(const VehiclePath& path, const VehicleMotion& motion,
                                                          const Terrain& terrain, const Scenario& scenario, Rng rng);

}  // namespace semantic_mht_slam
