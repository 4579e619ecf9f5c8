#pragma once

#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// An estimator that knows nothing yet, as its parts.
SlamParts makeParts(const SlamConfig& config, const ClassTable& classes);

/// The parts as a state. `fitted` is the configuration with the lengths of their detector (see `fittedTo`).
SlamState stateOf(const SlamConfig& fitted, const SlamParts& parts);

}  // namespace semantic_mht_slam
