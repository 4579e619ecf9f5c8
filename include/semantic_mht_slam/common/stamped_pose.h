#pragma once

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// A pose of the base frame at a time, in a world frame that the holder names.
struct StampedPose {
  Stamp stamp = 0;
  Pose T_world_base;
};

}  // namespace semantic_mht_slam
