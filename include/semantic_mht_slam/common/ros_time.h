#pragma once

#include "semantic_mht_slam/common/stamp.h"

namespace semantic_mht_slam {

/// The last second that a ROS message or bag can hold, in 2106.
constexpr Stamp kLastStamp = 4294967295LL * 1000000000LL;

/// Whether ROS can write it; what is stamped otherwise is taken from nobody.
constexpr bool isRosTime(Stamp stamp) {
  return stamp >= 0 && stamp <= kLastStamp;
}

}  // namespace semantic_mht_slam
