#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Places round the base, by range and bearing (ahead, abeam, behind), for what is learned of each.
struct PolarCells {
  static constexpr int kRanges = 5;
  static constexpr int kBearings = 3;
  static constexpr int kCount = kRanges * kBearings;

  /// The cell of a place in the base frame, 0 to kCount - 1; what is beyond `max_range_m` is in the outermost one.
  static int cellOf(const Eigen::Vector3d& position_m, double max_range_m) {
    const double range_m = position_m.head<2>().norm();
    const int range = static_cast<int>(std::min<double>(kRanges - 1, kRanges * range_m / max_range_m));
    const double cosine = range_m > 0.0 ? position_m.x() / range_m : 1.0;
    const int bearing = cosine > 0.5 ? 0 : cosine > -0.5 ? 1 : 2;
    return range * kBearings + bearing;
  }

  /// Its share of the disc of radius `max_range_m`.
  static double areaShare(int cell) {
    const int range = cell / kBearings;
    return (2.0 * range + 1.0) / (kRanges * kRanges * kBearings);
  }
};

}  // namespace semantic_mht_slam
