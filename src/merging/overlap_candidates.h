#pragma once

#include <vector>

#include "semantic_mht_slam/common/pose_cov.h"
#include "semantic_mht_slam/merging/overlap.h"

namespace semantic_mht_slam {

/// A scene of b that was laid onto one of a.
struct OverlapCandidate {
  KeyframeId a;
  KeyframeId b;
  Pose T_a_b;  ///< between the base frames
  double log_evidence = 0.0;
  int pairs = 0;
  std::vector<LandmarkId> landmarks;  ///< of b, in its scene
};

/// The scenes that look most alike, laid onto each other, best evidence first. Poses of the maps are not used.
std::vector<OverlapCandidate> findCandidates(const MergeMap& a, const MergeMap& b, const MergeSettings& settings,
                                             const MergeConfig& config);

/// Sets of candidates that agree with each other by the odometry of both maps, each best one first; the likeliest set
/// first. A candidate is in one set.
std::vector<std::vector<OverlapCandidate>> consistentSets(std::vector<OverlapCandidate> candidates, const MergeMap& a,
                                                          const MergeMap& b, const MergeSettings& settings,
                                                          const MergeConfig& config);

/// Whether two pairs of keyframes say the same of where the maps lie.
bool agree(const OverlapAnchor& known, const OverlapAnchor& other, const MergeMap& a, const MergeMap& b,
           const MergeSettings& settings, const MergeConfig& config);

}  // namespace semantic_mht_slam
