#pragma once

#include <Eigen/Core>

#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

struct Measurement;

/// Noise of the centroids of a class's objects, as a detector without stated covariances measures them at some range.
struct ClassNoise {
  Eigen::Vector3d stddev_m = Eigen::Vector3d::Zero();             ///< along the ray in the plane, across it, vertically
  Eigen::Vector3d outlier_variance_m2 = Eigen::Vector3d::Zero();  ///< added if the centroid is far off, same axes
  double wander_variance_per_m = 0.0;                             ///< growth with the distance driven
};

/// What the noise of a measurement is if it shows an object of a class other than the detected one: how far a centroid
/// is off depends on what it is the centroid of (a bush that is called a trunk is as wide as ever). Noise that was
/// stated by the detector stays as it is.
struct ObjectNoise {
  Eigen::Matrix3d cov_m2;
  Eigen::Matrix3d outlier_cov_m2;
  double wander_variance_per_m;
};

/// Columns, in the axes of the submap: along the ray in the plane of the base, across it, upwards.
Eigen::Matrix3d rayAxes(const Measurement& measurement);

ObjectNoise noiseOfObject(const Measurement& measurement, ClassIndex object_class);

/// The measurement with that noise. Returns `measurement` itself, or `changed` after filling it.
const Measurement& ofObject(const Measurement& measurement, ClassIndex object_class, Measurement& changed);

}  // namespace semantic_mht_slam
