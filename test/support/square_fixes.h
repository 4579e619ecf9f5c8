#pragma once

#include <cmath>

#include "semantic_mht_slam/models/gnss_fix.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {

/// Positions by satellites of a `SquareDrive`, about a place in Zurich: the map frame is turned by `kSquareYaw_rad`
/// from east.
constexpr GeodeticPoint kSquareOrigin{47.3769, 8.5417, 408.0};
constexpr double kSquareYaw_rad = 0.7;
constexpr double kSquareFixStddev_m = 0.5;

inline Pose squareInEnu() {
  return {expRotation({0.0, 0.0, kSquareYaw_rad}), Eigen::Vector3d::Zero()};
}

/// What the receiver says at frame `i`; where the antenna is above the base the message does not say.
inline GnssFix squareFixAt(const SquareDrive& drive, int i, double stddev_m = kSquareFixStddev_m) {
  Rng rng = Rng(31).fork("fix", static_cast<std::uint64_t>(i));
  const Eigen::Vector3d noise_m(rng.normal(0.0, stddev_m), rng.normal(0.0, stddev_m), rng.normal(0.0, stddev_m));
  GnssFix fix;
  fix.stamp = SquareDrive::stampAt(i);
  fix.place = toGeodetic(kSquareOrigin, squareInEnu() * drive.truthAt(i).translation_m + noise_m);
  fix.cov_m2 = Eigen::Matrix3d(Eigen::Vector3d::Constant(stddev_m * stddev_m).asDiagonal());
  return fix;
}

/// Feeds frames [begin, end), with a fix at every `step`-th, which comes when the vehicle is `late` frames further.
inline void feedWithFixes(Slam& slam, const SquareDrive& drive, int begin, int end, int step = 5, int late = 0) {
  for (int i = begin; i < end; ++i) {
    if (i >= late && (i - late) % step == 0) slam.addFix(squareFixAt(drive, i - late));
    drive.feed(slam, i, i + 1);
  }
}

}  // namespace semantic_mht_slam
