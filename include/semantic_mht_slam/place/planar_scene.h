#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// An object of a scene, seen from above.
struct PlanarObject {
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();  ///< horizontal, base frame of the keyframe
  double height_m = 0.0;
  double variance_m2 = 1.0;                              ///< of each horizontal coordinate, mean of both
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< of the position, base frame, against another pass
  Eigen::Matrix3d map_cov_m2 = Eigen::Matrix3d::Zero();  ///< the part of a landmark's estimate; zero for a detection
  double density_per_m2 = 0.0;                           ///< of objects of its class around it, itself included
  ClassIndex class_index = 0;
  LandmarkId landmark = kNoLandmark;
  int index = 0;  ///< in the scene
};

/// A scene prepared for comparisons: in an order that depends on values alone, by class.
struct PlanarScene {
  std::vector<PlanarObject> objects;                   ///< by class
  std::vector<int> class_begin;                        ///< objects of class c are [class_begin[c], class_begin[c + 1])
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();  ///< mean position; zero for an empty scene

  int size() const { return static_cast<int>(objects.size()); }
};

/// Radius within which neighbours count for the density of a class.
constexpr double kDensityRadius_m = 10.0;

/// Objects seen from above. `noise_floor_m` is what the centroid of an object differs between two passes although the
/// estimates are exact (viewpoint, clustering); the Gaussian transition of its class adds to it.
/// Throws std::invalid_argument for a class that the table lacks, a position that is not finite and a covariance
/// that is not positive definite.
PlanarScene makePlanarScene(const Scene& scene, const ClassTable& classes, double noise_floor_m);

}  // namespace semantic_mht_slam
