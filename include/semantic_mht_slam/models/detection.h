#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// One semantic object of one frame: a class and a centroid, no identity.
struct Detection {
  ClassIndex class_index = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< centroid in the base frame
  std::optional<double> score;                           ///< detector confidence in [0, 1]
  std::optional<Eigen::Matrix3d> cov_m2;                 ///< centroid covariance in the base frame
  std::optional<Eigen::Vector3d> size_m;                 ///< extents along the axes of the base frame
  std::optional<int> points;                             ///< sensor points that the object was made of
  bool is_moving = false;                                ///< the detector says that it moves
  int row = 0;                                           ///< place in its message or in its frame's rows of a file
};

/// The detections of one frame; the order is that of the file or message and means nothing.
using Detections = std::vector<Detection>;

}  // namespace semantic_mht_slam
