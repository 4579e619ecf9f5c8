#include "semantic_mht_slam/mapping/class_noise.h"

#include "semantic_mht_slam/mapping/hypothesis.h"

namespace semantic_mht_slam {
namespace {

constexpr double kLeastStddev_m = 0.01;

/// Columns: along a ray in the plane, across it, upwards.
Eigen::Matrix3d planarAxes(const Eigen::Vector3d& ray_m) {
  const double planar_m = ray_m.head<2>().norm();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (planar_m == 0.0) return axes;
  axes.topLeftCorner<2, 1>() = ray_m.head<2>() / planar_m;
  axes.block<2, 1>(0, 1) << -axes(1, 0), axes(0, 0);
  return axes;
}

bool isOwnNoise(const Measurement& measurement, ClassIndex object_class) {
  return measurement.noise_of_class == nullptr || object_class == measurement.class_index;
}

/// Along the ray in the plane, across it, upwards.
Eigen::Vector3d varianceChange(const Measurement& measurement, const ClassNoise& object) {
  const ClassNoise& detected = measurement.noise_of_class->at(static_cast<std::size_t>(measurement.class_index));
  return object.stddev_m.cwiseAbs2() - detected.stddev_m.cwiseAbs2();
}

}  // namespace

Eigen::Matrix3d rayAxes(const Measurement& measurement) {
  return measurement.R_submap_base.toRotationMatrix() * planarAxes(measurement.ray_m);
}

ObjectNoise noiseOfObject(const Measurement& measurement, ClassIndex object_class) {
  if (isOwnNoise(measurement, object_class)) {
    return {measurement.cov_m2, measurement.outlier_cov_m2, measurement.wander_variance_per_m};
  }
  const ClassNoise& object = measurement.noise_of_class->at(static_cast<std::size_t>(object_class));
  const Eigen::Matrix3d axes = rayAxes(measurement);
  const Eigen::Vector3d change_m2 = varianceChange(measurement, object);
  return {measurement.cov_m2 + axes * change_m2.asDiagonal() * axes.transpose(),
          axes * object.outlier_variance_m2.asDiagonal() * axes.transpose(), object.wander_variance_per_m};
}

const Measurement& ofObject(const Measurement& measurement, ClassIndex object_class, Measurement& changed) {
  if (isOwnNoise(measurement, object_class)) return measurement;
  const ClassNoise& object = measurement.noise_of_class->at(static_cast<std::size_t>(object_class));
  const ObjectNoise noise = noiseOfObject(measurement, object_class);
  changed = measurement;
  changed.cov_m2 = noise.cov_m2;
  changed.noise_stddev_m = (measurement.noise_stddev_m.cwiseAbs2() + varianceChange(measurement, object))
                               .cwiseMax(kLeastStddev_m * kLeastStddev_m)
                               .cwiseSqrt();
  changed.outlier_cov_m2 = noise.outlier_cov_m2;
  changed.wander_variance_per_m = noise.wander_variance_per_m;
  return changed;
}

}  // namespace semantic_mht_slam
