#pragma once

#include <algorithm>
#include <cstddef>

#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// Submaps whose landmarks the mapper itself may carry on into the present one.
inline std::size_t recentSubmaps(const SlamConfig& config) {
  const SubmapConfig& submap = config.mapper.submap;
  const double recent_m = std::max<double>(config.back_end.revisit.min_driven_m, submap.propagation_m);
  return static_cast<std::size_t>(recent_m / submap.length_m) + 2;
}

}  // namespace semantic_mht_slam
