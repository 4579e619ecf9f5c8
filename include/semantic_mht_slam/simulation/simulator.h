#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/simulation/scenario.h"

namespace semantic_mht_slam {

/// A thing, or a car for as long as it stood at one place.
struct SimulatedLandmark {
  int id = 0;  ///< index in SimulatedDrive::landmarks
  ClassIndex class_index = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< true centroid, map frame
};

/// A drive with its truth. The base frame is that of the sensor (x forward, y left, z up), the map frame the base frame
/// of frame 0; one entry a frame.
struct SimulatedDrive {
  std::vector<Stamp> stamps;                    ///< from 0
  std::vector<Pose> T_map_base;                 ///< truth, begins with the identity
  std::vector<Pose> T_odom_base;                ///< odometry, begins with the identity
  std::vector<Detections> detections;           ///< base frame, whole millimetres
  std::vector<std::vector<int>> truth_ids;      ///< a detection's landmark id, -1 clutter, -2 moving car
  std::vector<SimulatedLandmark> landmarks;     ///< all that came near
  std::vector<std::pair<int, int>> loop_pairs;  ///< (i, j), i - j > 50 frames, less than 3 m apart in the plane
  Pose T_cam0_base;                             ///< camera with x right, y down, z forward, as KITTI's trajectories
};

/// Simulates a drive through a town. The same scenario and seed give the same values. Town, route, detector and
/// odometry draw from sources of their own: a change of the detector leaves the town and the route as they were. Throws
/// InputError naming the field if the scenario cannot be built or the table lacks a class.
SimulatedDrive simulateDrive(const Scenario& scenario, const ClassTable& table, std::uint64_t seed);

/// Loop pairs of a trajectory: (i, j), ascending, with i - j > 50 frames and a planar distance below 3 m, the protocol
/// of Li et al., "SSC: Semantic Scan Context for Large-Scale Place Recognition" (IROS 2021).
std::vector<std::pair<int, int>> findLoopPairs(const std::vector<Pose>& T_map_base);

}  // namespace semantic_mht_slam
