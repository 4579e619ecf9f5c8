#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/app/simulated_dataset.h"
#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/simulation/simulator.h"

namespace semantic_mht_slam {

/// Two rounds of 500 m through parallel streets, which look alike. Between 200 and 280 m of a round next to nothing is
/// seen: there are submaps with and without something to recognise.
inline SimulatedDrive simulateRounds(const ClassTable& classes) {
  constexpr double kRound_m = 500.0;
  const Scenario scenario = loadScenario(packageConfigFile("scenarios/parallel_streets.yaml"),
                                         {"route.length=1000", "route.round=" + std::to_string(kRound_m)});
  SimulatedDrive drive = simulateDrive(scenario, classes, 2);
  double driven_m = 0.0;
  for (std::size_t i = 0; i < drive.detections.size(); ++i) {
    if (i > 0) driven_m += (drive.T_map_base[i].translation_m - drive.T_map_base[i - 1].translation_m).norm();
    const double in_round_m = std::fmod(driven_m, kRound_m);
    if (in_round_m > 200.0 && in_round_m < 280.0 && drive.detections[i].size() > 1) {
      drive.detections[i].resize(1);
      drive.truth_ids[i].resize(1);
    }
  }
  return drive;
}

inline Recording toRecording(const SimulatedDrive& drive) {
  Recording recording;
  for (std::size_t i = 0; i < drive.stamps.size(); ++i) {
    recording.odometry.push_back({drive.stamps[i], drive.T_odom_base[i]});
    recording.detector_frames.push_back({drive.stamps[i], drive.detections[i]});
  }
  return recording;
}

}  // namespace semantic_mht_slam
