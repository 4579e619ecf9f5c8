#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "semantic_mht_slam/mapping/hypothesis_tree.h"

namespace semantic_mht_slam {

inline ClassTable makeTable() {
  std::vector<ClassInfo> classes(2);
  classes[0].name = "pole";
  classes[1].name = "trunk";
  classes[1].id = 1;
  return ClassTable(classes, "test");
}

/// A well-known pole, id 1, class 0.
inline HypothesisLandmark makePole(double x_m, int observations) {
  auto pole = std::make_shared<TrackedLandmark>();
  pole->id = 1;
  pole->position = {Eigen::Vector3d(x_m, 0.0, 0.0), 0.01 * Eigen::Matrix3d::Identity()};
  pole->class_probs = ClassProbs::Zero(2);
  pole->class_probs << 0.99, 0.01;
  pole->observations = observations;
  Existence existence;
  existence.log_odds = 5.0;
  return {std::move(pole), existence};
}

/// Of class 0, 0.2 m off and, if it is an outlier, 0.6 m more.
inline Measurement makeMeasurement(const Eigen::Vector3d& position_m, LandmarkId id_if_new) {
  Measurement measurement;
  measurement.position_m = position_m;
  measurement.cov_m2 = 0.04 * Eigen::Matrix3d::Identity();
  measurement.outlier_cov_m2 = 0.36 * Eigen::Matrix3d::Identity();
  measurement.id_if_new = id_if_new;
  return measurement;
}

inline TreeInput makeInputOf(std::vector<Measurement> measurements, std::size_t frame = 0) {
  TreeInput input;
  input.frame = frame;
  input.measurements = std::move(measurements);
  return input;
}

}  // namespace semantic_mht_slam
