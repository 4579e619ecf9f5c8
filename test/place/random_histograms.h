#pragma once

#include <algorithm>
#include <cstdint>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/place/class_histogram.h"

namespace semantic_mht_slam {

/// Histogram of `objects` objects of random classes: many zeros, and many histograms alike where objects are few.
inline ClassHistogram randomHistogram(int classes, int objects, Rng& rng) {
  ClassHistogram counts = ClassHistogram::Zero(classes);
  for (int i = 0; i < objects; ++i) {
    // Two draws, the lower one: classes are not equally frequent.
    const auto size = static_cast<std::uint64_t>(classes);
    counts[static_cast<Eigen::Index>(std::min(rng.index(size), rng.index(size)))] += 1.0;
  }
  if (objects > 0) counts /= static_cast<double>(objects);
  return counts;
}

}  // namespace semantic_mht_slam
