#pragma once

#include <vector>

#include "semantic_mht_slam/mapping/hypothesis.h"
#include "semantic_mht_slam/registration/registration.h"

namespace semantic_mht_slam {

/// Mean number of detections of the landmarks; 0 without any.
double averageObservations(const std::vector<MixtureLandmark>& landmarks);

/// Whether a hypothesis that knows where it is in the earlier map expects to see a landmark of it. What an earlier pass
/// saw but shortly, compared with the average of its landmarks, says little when it is not seen again, and is often a
/// ghost or a duplicate.
bool isExpected(const MixtureLandmark& earlier, double average_observations);

/// An expected landmark: number `index` of the earlier map, at `position` (submap frame).
HypothesisLandmark expectedLandmark(const MixtureLandmark& earlier, int index, const Gaussian3& position,
                                    double driven_m, const ClassTable& classes, const RegistrationConfig& config);

}  // namespace semantic_mht_slam
