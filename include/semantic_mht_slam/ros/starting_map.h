#pragma once

#include <memory>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// The estimator to begin with: new, or that of the map file `node.map`, localizing if `node.mode` says so. Throws
/// InputError for a file that cannot be used, or given up, and for localization without a map.
std::unique_ptr<Slam> startingSlam(const SystemConfig& config, const ClassTable& classes);

}  // namespace semantic_mht_slam
