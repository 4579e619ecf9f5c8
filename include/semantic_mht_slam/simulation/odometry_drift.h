#pragma once

#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/simulation/scenario.h"

namespace semantic_mht_slam {

/// The drive as its odometry reports it: T_odom_base from the true T_world_base, beginning with the identity. Every
/// error grows with the distance driven; a standing vehicle does not drift. Heading and tilt rates are white noise plus
/// an Ornstein-Uhlenbeck bias; translation has a scale error, constant and varying, and a constant error of direction,
/// as of a sensor mounted askew.
std::vector<Pose> simulateOdometry(const std::vector<Pose>& T_world_base, const SimulatedOdometryConfig& config,
                                   Rng rng);

}  // namespace semantic_mht_slam
