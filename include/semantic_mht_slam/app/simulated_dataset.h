#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/simulation/simulator.h"

namespace semantic_mht_slam {

/// A scenario file with `overrides` (KEY=VALUE). Throws InputError or ConfigError.
Scenario loadScenario(const std::string& path, const std::vector<std::string>& overrides = {});

/// Writes a simulated drive as a data-set folder (made if missing) with its truth: objects_landmark.csv
/// (frame,landmark; a row a detection, -1 clutter, -2 moving), landmarks.csv (landmark,class,x,y,z in the map frame)
/// and loop_pairs.csv (i,j). Throws InputError if something cannot be written.
void writeSimulatedDataset(const SimulatedDrive& drive, const ClassTable& classes, const std::string& folder);

}  // namespace semantic_mht_slam
