#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/simulation/scenario.h"
#include "semantic_mht_slam/simulation/street_network.h"

namespace semantic_mht_slam {

/// An upright box, or a point where its length and depth are zero. A vehicle stands for a place where cars park.
struct TownObject {
  TownClass town_class = TownClass::kPole;
  int street = 0;                                        ///< the street it stands at
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< centroid, world frame
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< of its length
  double length_m = 0.0;
  double depth_m = 0.0;
};

/// Streets and what stands along them.
struct Town {
  StreetNetwork network;
  std::vector<TownObject> objects;
};

/// Draws a town. Objects keep clear of every roadway. Depends on `scenario.network` and the layout values of
/// `scenario.classes` only.
Town buildTown(const Scenario& scenario, const Rng& rng);

/// Centroid of the part of an upright box that a sensor at `sensor_m` sees: the faces turned to it, each point weighted
/// with the density of lidar returns there, cos(incidence) / range^2. Horizontal coordinates, world frame. A sensor
/// inside the box gives the centre.
Eigen::Vector2d visibleCentroid(const TownObject& object, const Eigen::Vector2d& sensor_m);

}  // namespace semantic_mht_slam
