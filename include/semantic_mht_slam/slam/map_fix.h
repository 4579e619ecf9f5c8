#pragma once

#include "semantic_mht_slam/common/pose_cov.h"
#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// A moment at which the pose in the map was found.
struct MapFix {
  Stamp stamp = 0;
  Pose T_odom_base;
  Pose T_map_base;
  FixedAxesCov cov = unknownPoseCov();  ///< axes of the map
};

}  // namespace semantic_mht_slam
