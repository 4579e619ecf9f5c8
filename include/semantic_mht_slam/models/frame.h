#pragma once

#include <cstddef>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

/// What a detector saw at one time, with the odometry pose at that time.
struct Frame {
  std::size_t index = 0;  ///< counts the detector's frames from 0, dropped ones included
  Stamp stamp = 0;
  Pose T_odom_base;
  Detections detections;  ///< base frame
};

}  // namespace semantic_mht_slam
