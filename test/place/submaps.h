#pragma once

#include <vector>

#include "semantic_mht_slam/map/submap.h"

namespace semantic_mht_slam {

/// A landmark that surely exists, of one of `classes` classes.
inline MixtureLandmark makeLandmark(const Eigen::Vector3d& position_m, ClassIndex class_index, int classes,
                                    double existence_prob = 1.0) {
  MixtureLandmark landmark;
  landmark.position.mean_m = position_m;
  landmark.position.cov_m2 = 0.01 * Eigen::Matrix3d::Identity();
  landmark.components = {{1.0, landmark.position}};
  landmark.class_probs = ClassProbs::Zero(classes);
  landmark.class_probs[class_index] = 1.0;
  landmark.existence_prob = existence_prob;
  return landmark;
}

/// A submap with landmarks of these classes, a metre apart.
inline Submap makeSubmap(const std::vector<ClassIndex>& landmark_classes, int classes) {
  Submap submap;
  for (const ClassIndex class_index : landmark_classes) {
    const auto i = static_cast<double>(submap.landmarks.size());
    submap.landmarks.push_back(makeLandmark({i, i * i, -i}, class_index, classes));
  }
  return submap;
}

}  // namespace semantic_mht_slam
