#pragma once

#include <optional>

#include <Eigen/Core>

#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/models/geodetic.h"

namespace semantic_mht_slam {

/// A position by satellites, as a receiver gives it.
struct GnssFix {
  Stamp stamp = 0;
  bool has_fix = true;                       ///< false: the receiver says that it has none
  GeodeticPoint place;                       ///< of the antenna; the altitude is NaN if it is not known
  std::optional<Eigen::Matrix3d> cov_m2;     ///< east, north, up; none: not known
  std::optional<Eigen::Vector3d> antenna_m;  ///< in the base frame; none: where the configuration has it
};

}  // namespace semantic_mht_slam
