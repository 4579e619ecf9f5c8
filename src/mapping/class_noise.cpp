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

}  // namespace

Measurement ofObject(const Measurement& measurement, ClassIndex object_class) {
  if (measurement.noise_of_class == nullptr || object_class == measurement.class_index) return measurement;
  const ClassNoise& detected = measurement.noise_of_class->at(static_cast<std::size_t>(measurement.class_index));
  const ClassNoise& object = measurement.noise_of_class->at(static_cast<std::size_t>(object_class));
  const Eigen::Vector3d change_m2 = object.stddev_m.cwiseAbs2() - detected.stddev_m.cwiseAbs2();
  const Eigen::Matrix3d axes = measurement.R_submap_base.toRotationMatrix() * planarAxes(measurement.ray_m);
  Measurement result = measurement;
  result.cov_m2 += axes * change_m2.asDiagonal() * axes.transpose();
  result.noise_stddev_m =
      (measurement.noise_stddev_m.cwiseAbs2() + change_m2).cwiseMax(kLeastStddev_m * kLeastStddev_m).cwiseSqrt();
  result.outlier_variance_m2.setConstant(object.outlier_variance_m2);
  result.wander_variance_per_m = object.wander_variance_per_m;
  return result;
}

}  // namespace semantic_mht_slam
