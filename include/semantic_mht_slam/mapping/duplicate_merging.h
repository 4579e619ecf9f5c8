#pragma once

#include <functional>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/side_by_side.h"
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
/// one object is seen twice in a frame only when the detector splits it, and its parts are near each other: what `seen`
/// excludes is not merged. A landmark of another class that stands nearer than chance puts another object, and that
/// hardly any frame shows alone, is a second box of the same object; `box_prob` is the probability of one. Returns the
/// second name and the first of what was merged; `landmarks` loses the second ones. `detectorCov` is the noise
/// covariance of a class, map axes, m^2.
std::vector<SameLandmark> mergeDuplicates(const DuplicateConfig& config, double box_prob,
                                          const std::vector<FusedAssociations>& associations, const SideBySide& seen,
                                          const std::function<Eigen::Matrix3d(ClassIndex)>& detectorCov,
                                          std::vector<MixtureLandmark>& landmarks);

}  // namespace semantic_mht_slam
