#include "semantic_mht_slam/simulation/simulator.h"

#include <algorithm>

#include "semantic_mht_slam/simulation/detector.h"
#include "semantic_mht_slam/simulation/landmark_schedule.h"
#include "semantic_mht_slam/simulation/odometry_drift.h"
#include "semantic_mht_slam/simulation/route.h"
#include "semantic_mht_slam/simulation/spatial_grid.h"
#include "semantic_mht_slam/simulation/town.h"
#include "semantic_mht_slam/simulation/traffic.h"
#include "semantic_mht_slam/simulation/vehicle_motion.h"

namespace semantic_mht_slam {
namespace {

constexpr double kLoopDistance_m = 3.0;
constexpr int kLoopFrames = 50;

/// Length of streets for a path of the wanted length: the smoothed path is 0.71 radii shorter than a right angle,
/// passes it up to pi/2 lane offsets inside, and there is at most one corner a block.
double plannedLength(const Scenario& scenario) {
  const double block_m = std::min(scenario.network.block_width_m, scenario.network.block_depth_m);
  const double corner_m = 0.71 * scenario.route.corner_radius_m + 1.6 * scenario.route.lane_offset_m;
  return scenario.route.length_m * (1.0 + corner_m / (0.7 * block_m)) + 30.0;
}

/// KITTI's camera: x right, y down, z forward; the lever arm is about KITTI's, 27 cm ahead and 8 cm below.
Pose cameraFromBase() {
  return {Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {0.0, -0.08, -0.27}};
}

std::vector<Pose> relativeToFirst(const std::vector<Pose>& T_world_base) {
  const Pose T_first_world = T_world_base.front().inverse();
  std::vector<Pose> result = {Pose::identity()};  // exactly, whatever the rounding
  for (std::size_t k = 1; k < T_world_base.size(); ++k) result.push_back(T_first_world * T_world_base[k]);
  return result;
}

std::vector<SimulatedLandmark> toMapFrame(const std::vector<ScheduledLandmark>& scheduled, const Pose& T_map_world,
                                          const std::array<ClassIndex, kTownClassCount>& class_indices) {
  std::vector<SimulatedLandmark> landmarks;
  for (const ScheduledLandmark& landmark : scheduled) {
    const ClassIndex class_index = class_indices[static_cast<std::size_t>(landmark.object.town_class)];
    landmarks.push_back({static_cast<int>(landmarks.size()), class_index, T_map_world * landmark.object.position_m});
  }
  return landmarks;
}

}  // namespace

std::vector<std::pair<int, int>> findLoopPairs(const std::vector<Pose>& T_map_base) {
  std::vector<Eigen::Vector2d> positions;
  positions.reserve(T_map_base.size());
  for (const Pose& pose : T_map_base) positions.push_back(pose.translation_m.head<2>());
  const SpatialGrid grid(positions, kLoopDistance_m);
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < static_cast<int>(positions.size()); ++i) {
    const Eigen::Vector2d& position = positions[static_cast<std::size_t>(i)];
    for (const int j : grid.near(position, kLoopDistance_m)) {
      const double distance = (positions[static_cast<std::size_t>(j)] - position).norm();
      if (i - j > kLoopFrames && distance < kLoopDistance_m) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

SimulatedDrive simulateDrive(const Scenario& scenario, const ClassTable& table, std::uint64_t seed) {
  validate(scenario);
  const auto class_indices = townClassIndices(table);
  const Rng rng(seed);
  const Rng route_rng = rng.fork("route");
  const Rng detector_rng = rng.fork("detector");

  const Town town = buildTown(scenario, rng.fork("town"));
  const std::vector<Leg> legs =
      planRoute(town.network, scenario.route, plannedLength(scenario), route_rng.fork("legs"));
  const VehiclePath path = smoothPath(town.network, legs, scenario.route, route_rng.fork("path"));
  const VehicleMotion motion = drivePath(path, town.network.terrain, scenario.route, route_rng.fork("motion"));
  const auto landmarks = scheduleLandmarks(town, motion, scenario, rng.fork("parking"));
  const auto traffic = simulateTraffic(path, motion, town.network.terrain, scenario, rng.fork("traffic"));

  SimulatedDrive drive;
  drive.stamps = motion.stamps;
  drive.T_map_base = relativeToFirst(motion.T_world_base);
  drive.T_odom_base = simulateOdometry(motion.T_world_base, scenario.odometry, rng.fork("odometry"));
  for (SimulatedFrame& frame : simulateDetections(landmarks, traffic, motion, scenario, class_indices, detector_rng)) {
    drive.detections.push_back(std::move(frame.detections));
    drive.truth_ids.push_back(std::move(frame.truth_ids));
  }
  drive.landmarks = toMapFrame(landmarks, motion.T_world_base.front().inverse(), class_indices);
  drive.loop_pairs = findLoopPairs(drive.T_map_base);
  drive.T_cam0_base = cameraFromBase();
  return drive;
}

}  // namespace semantic_mht_slam
