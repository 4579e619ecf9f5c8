#pragma once

namespace semantic_mht_slam {

/// Odometry whose error is a random walk: its variance grows with the distance driven.
struct OdometryNoise {
  double stddev_m = 0.045;     ///< of each axis, m/sqrt(m)
  double stddev_rad = 0.0007;  ///< about each axis, rad/sqrt(m)
};

}  // namespace semantic_mht_slam
