#pragma once

#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/simulation/scenario.h"
#include "semantic_mht_slam/simulation/street_network.h"
#include "semantic_mht_slam/simulation/street_router.h"

namespace semantic_mht_slam {

/// Plans a drive of at least `length_m` metres that never turns on a street. The shares of revisited streets follow the
/// configuration: whichever kind of street is most behind its share is sought next. After `round` metres the drive goes
/// back to its start and is made again.
/// Throws InputError naming the field if the network has too few streets or no way to turn round.
std::vector<Leg> planRoute(const StreetNetwork& network, const RouteConfig& config, double length_m, Rng rng);

}  // namespace semantic_mht_slam
