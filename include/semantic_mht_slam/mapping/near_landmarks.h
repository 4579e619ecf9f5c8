#pragma once

#include <vector>

#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/models/frame.h"

namespace semantic_mht_slam {

/// Pairs of landmarks that frames show so near each other that they may be parts of one object: no further apart than
/// the two objects are large and the noise of their centroids explains (`gate_mahalanobis_sq`, on their covariances).
/// `frames` are calibrated (`Mapper::calibrated`), `associations` those of all their detections, in their order.
std::vector<NearLandmarks> findNearLandmarks(const std::vector<Frame>& frames,
                                             const std::vector<DetectionAssociation>& associations,
                                             double gate_mahalanobis_sq);

}  // namespace semantic_mht_slam
