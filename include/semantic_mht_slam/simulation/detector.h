#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/simulation/landmark_schedule.h"
#include "semantic_mht_slam/simulation/scenario.h"

namespace semantic_mht_slam {

constexpr int kClutterId = -1;
constexpr int kMovingId = -2;

/// Detections of one frame and what each of them shows: a landmark's number, kClutterId or kMovingId.
struct SimulatedFrame {
  Detections detections;
  std::vector<int> truth_ids;
};

/// Table indices of the simulated classes, in the order of TownClass. Throws InputError naming the classes that the
/// table lacks.
std::array<ClassIndex, kTownClassCount> townClassIndices(const ClassTable& table);

/// Everything the detector sees during a drive. Each frame and each landmark draws from a source of its own, so that
/// one more object leaves the others as they were. Positions are in the base frame, rounded to millimetres.
std::vector<SimulatedFrame> simulateDetections(const std::vector<ScheduledLandmark>& landmarks,
                                               const std::vector<std::vector<Eigen::Vector3d>>& traffic,
                                               const VehicleMotion& motion, const Scenario& scenario,
                                               const std::array<ClassIndex, kTownClassCount>& class_indices,
                                               const Rng& rng);

}  // namespace semantic_mht_slam
