#pragma once

#include <cstddef>

#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

/// Whether the numbers of a detection can be computed with: a position within 100 km, a score in [0, 1], no negative
/// size, and a covariance that is symmetric and positive definite beyond doubt: all deviations between 1 um and 100 km,
/// and the least at least 1e-6 of the largest.
bool isUsable(const Detection& detection);

/// Removes what lies at exactly 0, 0, 0: the sensor had no range there. Returns how many went.
std::size_t removeAtOrigin(Detections& detections);

/// Takes covariances away that say that nothing is known: a variance that is not positive, or a deviation beyond the
/// range. Returns how many.
std::size_t forgetUnknownCovariances(Detections& detections);

/// Removes what is not usable; the others keep their order. Returns how many went.
std::size_t removeUnusable(Detections& detections);

}  // namespace semantic_mht_slam
