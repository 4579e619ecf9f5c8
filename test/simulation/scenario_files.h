#pragma once

#include <string>

#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/simulation/scenario.h"

namespace semantic_mht_slam {

/// The seven classes of the simulator, and one more before them so that indices differ from TownClass.
ClassTable simulationClasses();

/// A shipped scenario by its name, config/scenarios/NAME.yaml.
Scenario shippedScenario(const std::string& name);

}  // namespace semantic_mht_slam
