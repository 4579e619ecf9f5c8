#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/models/gnss_fix.h"

namespace semantic_mht_slam {

/// Positions by satellites, in the order of their stamps.
struct FixesFile {
  std::vector<GnssFix> fixes;
  std::string notice;  ///< of columns that were ignored; empty: none
};

/// Reads a CSV file with the columns time (s, as in times.txt), latitude, longitude (degrees, WGS 84), and optional
/// ones: altitude (m above the ellipsoid), stddev_east, stddev_north, stddev_up (m). An empty cell is not known;
/// numbers that are not finite or out of range stay, for the estimator to count. Throws InputError that names file,
/// line and column.
FixesFile readFixes(const std::string& path);

}  // namespace semantic_mht_slam
