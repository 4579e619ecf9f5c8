#pragma once

#include <cmath>
#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/models/gnss_fix.h"
#include "semantic_mht_slam/simulation/simulator.h"

namespace semantic_mht_slam {

/// A receiver on a simulated drive: errors that stay alike for half a minute, and now and then one of another kind.
struct SimulatedReceiver {
  double stddev_m = 1.0;  ///< horizontal; the vertical one is twice that
  double alike_s = 30.0;  ///< time constant of the errors
  double period_s = 1.0;
  double outlier_prob = 0.0;  ///< of a fix that is off by `outlier_m` in any direction
  double outlier_m = 30.0;
  Pose T_enu_map{expRotation({0.0, 0.0, 1.0}), {120.0, -40.0, 8.0}};
  GeodeticPoint origin{47.3769, 8.5417, 408.0};
};

inline std::vector<GnssFix> simulateFixes(const SimulatedDrive& drive, const SimulatedReceiver& receiver,
                                          std::uint64_t seed) {
  Rng rng(seed);
  const Eigen::Vector3d stddev_m(receiver.stddev_m, receiver.stddev_m, 2.0 * receiver.stddev_m);
  const auto white = [&] {
    return Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal()).cwiseProduct(stddev_m).eval();
  };
  const double kept = std::exp(-receiver.period_s / receiver.alike_s);
  Eigen::Vector3d error_m = white();
  std::vector<GnssFix> fixes;
  for (std::size_t i = 0; i < drive.stamps.size(); ++i) {
    if (!fixes.empty() && drive.stamps[i] - fixes.back().stamp < stampFromSeconds(receiver.period_s)) continue;
    if (!fixes.empty()) error_m = kept * error_m + std::sqrt(1.0 - kept * kept) * white();
    Eigen::Vector3d place_m = receiver.T_enu_map * drive.T_map_base[i].translation_m + error_m;
    const double direction_rad = rng.uniform(-M_PI, M_PI);
    if (rng.bernoulli(receiver.outlier_prob)) {
      place_m += receiver.outlier_m * Eigen::Vector3d(std::cos(direction_rad), std::sin(direction_rad), 0.5);
    }
    GnssFix& fix = fixes.emplace_back();
    fix.stamp = drive.stamps[i];
    fix.place = toGeodetic(receiver.origin, place_m);
    fix.cov_m2 = Eigen::Matrix3d(stddev_m.cwiseAbs2().asDiagonal());
  }
  return fixes;
}

}  // namespace semantic_mht_slam
