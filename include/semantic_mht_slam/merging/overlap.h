#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/merging/merge_config.h"
#include "semantic_mht_slam/merging/merge_map.h"

namespace semantic_mht_slam {

/// Two keyframes of two maps that show one place, if the maps overlap as a hypothesis says.
struct OverlapAnchor {
  KeyframeId a;
  KeyframeId b;
  Pose T_a_b;  ///< between the base frames
  double log_evidence = 0.0;
  double stddev_m = 0.0;  ///< more than a closure is off by
};

/// One way in which map b may lie in map a.
struct OverlapHypothesis {
  std::vector<OverlapAnchor> anchors;  ///< the first is what it began with
  double log_odds = 0.0;               ///< over "they do not overlap", nats
  double log_evidence = 0.0;           ///< the same without bounds on what a single tile may say
  int landmarks = 0;                   ///< that have a counterpart
  int tiles_found = 0;
  int tiles_missing = 0;  ///< that should be there and are not
};

/// What is known of two maps.
struct OverlapPosterior {
  std::vector<OverlapHypothesis> hypotheses;  ///< most likely first
  double prob = 0.0;                          ///< of the first one
  double none_prob = 1.0;                     ///< that they do not overlap; the rest is that of the other hypotheses
  bool is_decided = false;                    ///< they overlap as the first one says
  std::string reason;                         ///< why it is not; empty if it is
};

/// Where map b may lie in map a, with no frame in common: scenes that look alike are laid onto each other; what is
/// consistent is one hypothesis; each is asked tile by tile, the nearest first, whether what b saw is in a. A tile
/// bears witness once, bounded by the number of its landmarks, and against the hypothesis if a has seen the place
/// without it.
OverlapPosterior findOverlap(const MergeMap& a, const MergeMap& b, const MergeSettings& settings,
                             const MergeConfig& config);

/// A keyframe of b in the map frame of a as an anchor near it says, and how far that may be off.
RegistrationPrior priorAt(KeyframeId b_keyframe, const OverlapAnchor& anchor, const MergeMap& a, const MergeMap& b,
                          const MergeSettings& settings);

}  // namespace semantic_mht_slam
