#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/simulation/route.h"
#include "semantic_mht_slam/simulation/scenario.h"
#include "semantic_mht_slam/simulation/street_network.h"

namespace semantic_mht_slam {

/// Smooth path of a vehicle on the streets, world frame, points `kPathStep_m` apart.
struct VehiclePath {
  std::vector<Eigen::Vector2d> points_m;
  std::vector<double> corners_m;  ///< distances along the path at which a corner of the network is passed

  double length() const;
  StreetPoint at(double along_m) const;
};

constexpr double kPathStep_m = 0.5;

/// The legs with rounded corners, on the right of the centre line, wandering a little across it.
VehiclePath smoothPath(const StreetNetwork& network, const std::vector<Leg>& legs, const RouteConfig& config, Rng rng);

/// Where the vehicle is at each frame.
struct VehicleMotion {
  std::vector<Stamp> stamps;       ///< from 0
  std::vector<double> along_m;     ///< distance along the path
  std::vector<Pose> T_world_base;  ///< sensor: x forward, y left, z up
};

/// Drives the path until its end or `config.length_m`: slows in curves, stops at some corners, tilts with the ground
/// and a little by itself.
VehicleMotion drivePath(const VehiclePath& path, const Terrain& terrain, const RouteConfig& config, Rng rng);

}  // namespace semantic_mht_slam
