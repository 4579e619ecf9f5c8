#pragma once

#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/simulation/scenario.h"
#include "semantic_mht_slam/simulation/town.h"
#include "semantic_mht_slam/simulation/vehicle_motion.h"

namespace semantic_mht_slam {

/// Frames from coming near an object to leaving it, both included.
struct Pass {
  int first_frame = 0;
  int last_frame = 0;
};

/// An object that is there during some passes. A parking place becomes one landmark for each car that stood there.
struct ScheduledLandmark {
  TownObject object;
  std::vector<Pass> passes;
};

/// The passes of each object: runs of frames within the radius of `config`, joined where the gap is short.
std::vector<std::vector<Pass>> findPasses(const std::vector<TownObject>& objects, const VehicleMotion& motion,
                                          const PassesConfig& config, double frame_rate_hz);

/// The objects that come near at least once: things first, then cars, each kind in the order of the town.
std::vector<ScheduledLandmark> scheduleLandmarks(const Town& town, const VehicleMotion& motion,
                                                 const Scenario& scenario, const Rng& rng);

}  // namespace semantic_mht_slam
