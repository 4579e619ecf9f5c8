#pragma once

#include <vector>

#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/mapping/hypothesis.h"

namespace semantic_mht_slam {

/// Fuses the leaves of a tree (paper, section III): landmarks with one id are one across hypotheses; each becomes a
/// Gaussian mixture whose component weights are the summed weights of the hypotheses that agree, with its moments,
/// class probabilities and existence probability (0 in hypotheses that lack it). By rising id.
/// Weights must be normalised.
std::vector<MixtureLandmark> fuseHypotheses(const std::vector<MapHypothesis>& leaves);

/// The landmark of each measurement of a frame; kNoLandmark: a false positive.
struct FusedAssociations {
  std::size_t frame = 0;
  std::vector<LandmarkId> landmark_of_measurement;
  PoseOffset offset;  ///< of the odometry at the frame, by the likeliest leaf
};

/// The landmark with the largest summed weight for each measurement, frame by frame from the beginning of the history.
std::vector<FusedAssociations> fuseAssociations(const std::vector<MapHypothesis>& leaves);

}  // namespace semantic_mht_slam
