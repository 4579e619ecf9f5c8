#pragma once

#include <vector>

#include "semantic_mht_slam/mapping/hypothesis.h"

namespace semantic_mht_slam {

constexpr int kSettledObservations = 3;  ///< of a landmark that may correct a pose

/// The landmarks that are seen for sure (three observations, likelier than not) nearest to a place, within a radius, at
/// most `count`; nearest first.
std::vector<const TrackedLandmark*> nearestLandmarks(const MapHypothesis& leaf, const Eigen::Vector3d& center_m,
                                                     double radius_m, int count);

/// Those that were seen in this submap, at most `count`; the most observed first.
std::vector<const TrackedLandmark*> mostSeenLandmarks(const MapHypothesis& leaf, int count);

}  // namespace semantic_mht_slam
