#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/mapping/association.h"

namespace semantic_mht_slam::association_test {

inline ClassTable makeTable() {
  std::vector<ClassInfo> classes(3);
  for (int i = 0; i < 3; ++i) {
    classes[static_cast<std::size_t>(i)].id = i;
    classes[static_cast<std::size_t>(i)].name = std::string(1, static_cast<char>('a' + i));
  }
  classes[2].transition = Transition::kGaussian;
  classes[2].transition_stddev_m = 2.0;
  return ClassTable(classes, "test");
}

inline HypothesisLandmark makeLandmark(LandmarkId id, double x, ClassIndex class_index, int observations) {
  auto landmark = std::make_shared<TrackedLandmark>();
  landmark->id = id;
  landmark->position = {{x, 0.0, 0.0}, 0.01 * Eigen::Matrix3d::Identity()};
  landmark->class_probs = ClassProbs::Zero(3);
  landmark->class_probs[class_index] = 1.0;
  landmark->observations = observations;
  return {std::move(landmark), {}};
}

inline Measurement makeMeasurement(double x, ClassIndex class_index) {
  Measurement measurement;
  measurement.position_m = {x, 0.0, 0.0};
  measurement.cov_m2 = 0.01 * Eigen::Matrix3d::Identity();
  measurement.class_index = class_index;
  return measurement;
}

/// The paper's own setting: Gaussian noise, Kronecker delta of the classes.
inline MapperConfig makePaperConfig() {
  MapperConfig config;
  config.association.outlier_prob = 0.0;
  config.association.class_model = ClassModel::kDelta;
  config.association.split_prob = 0.0;
  return config;
}

}  // namespace semantic_mht_slam::association_test
