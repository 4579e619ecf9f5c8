#pragma once

#include <vector>

#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// A landmark of a map of which nothing else is known.
struct BareLandmark {
  ClassIndex class_index = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< z up
};

/// A map of bare landmarks as the parts of an estimator: rigid, with a keyframe wherever there are landmarks, as if a
/// vehicle had stood there that sees as far as some dozens of landmarks reach. Throws InputError for less than three.
SlamParts makeLandmarkMap(const std::vector<BareLandmark>& landmarks, const SlamConfig& config,
                          const ClassTable& classes);

}  // namespace semantic_mht_slam
