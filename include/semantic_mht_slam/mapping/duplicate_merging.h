#pragma once

#include <functional>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/mapping/fusion.h"

namespace semantic_mht_slam {

/// When two landmarks are one object.
struct DuplicateConfig {
  bool merge = true;
  double gate_mahalanobis_sq = 11.3;
  double split_prob = 0.1;
  double log_prior_odds = 0.0;
};

void describe(DuplicateConfig& config, Fields& fields);

/// Finds landmarks that stand where another of their class stands and are hardly ever seen together with it, and makes
/// them one. Two objects that the detector sees with probability p each are seen together in a share p of their frames;
/// one object is seen twice in a frame only when the detector splits it. Returns what was merged into what; `landmarks`
/// loses the merged ones. `detectorCov` is the noise covariance of a class, map axes, m^2.
std::vector<MergedLandmark> mergeDuplicates(const DuplicateConfig& config,
                                            const std::vector<FusedAssociations>& associations,
                                            const std::function<Eigen::Matrix3d(ClassIndex)>& detectorCov,
                                            std::vector<MixtureLandmark>& landmarks);

/// Gives the landmark `id` of a submap the name that the earlier map has for it. `merged` is what the submap has merged
/// so far; afterwards no chain of names in it runs in a circle and no two landmarks have one id: a landmark that has
/// the earlier name already takes the other one in, and an earlier name that was merged into `id` stays. Nothing
/// happens if `id` is not among the landmarks.
void joinEarlierLandmark(const MixtureLandmark& earlier, LandmarkId id, std::vector<MixtureLandmark>& landmarks,
                         std::vector<MergedLandmark>& merged);

}  // namespace semantic_mht_slam
