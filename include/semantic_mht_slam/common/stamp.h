#pragma once

#include <cmath>
#include <cstdint>

namespace semantic_mht_slam {

/// Time since the epoch of the data in nanoseconds; integers, as in ROS headers, so that no rounding separates a file
/// from a bag.
using Stamp = std::int64_t;

/// Seconds to nanoseconds, rounded to the nearest.
inline Stamp stampFromSeconds(double seconds) {
  return static_cast<Stamp>(std::llround(seconds * 1e9));
}

/// Nanoseconds to seconds.
inline double secondsFromStamp(Stamp stamp) {
  return static_cast<double>(stamp) * 1e-9;
}

}  // namespace semantic_mht_slam
