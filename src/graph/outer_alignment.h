#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// A point as the estimate has it and as it was measured in another frame.
struct PointPair {
  Eigen::Vector3d in_world_m;
  Eigen::Vector3d measured_m;  ///< outer frame
  Eigen::Matrix3d cov_m2;      ///< of the measurement
};

/// Measurements without which nothing is determined.
constexpr std::size_t kFewestPairs = 6;

/// T_outer_world as most of the measurements have it: a turn about the vertical and a translation. Empty as long as
/// they don't determine it: fewer than half of them agree, or the way between them is too short for their noise. The
/// same pairs in the same order give the same result.
std::optional<Pose> alignOuterFrame(const std::vector<PointPair>& pairs);

}  // namespace semantic_mht_slam
