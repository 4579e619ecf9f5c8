#pragma once

#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// What earlier passes know of the surroundings of a submap, and how far it may have drifted since.
struct EarlierMap {
  /// In the predicted frame of the submap: where it would be without drift since those passes. As the submaps that saw
  /// them last have them, and under the names there.
  std::vector<MixtureLandmark> landmarks;
  double stddev_xy_m = 3.0;  ///< of the submap's origin in the predicted frame, each axis
  double stddev_z_m = 1.0;
  double stddev_yaw_rad = 0.03;
};

/// Hypotheses over joint alignments against an earlier map.
struct MapAlignmentConfig {
  bool enabled = true;
  Length first_m{4.0};
  Length retry_m{13.0};
  int min_landmarks = 6;
  int max_landmarks = 40;
  Length radius_m{60.0};
  double log_prior_odds = 0.0;
  double max_log_evidence = 2.0;
  double accept_prob = 0.9;
  int min_matches = 5;
};

void describe(MapAlignmentConfig& config, Fields& fields);

}  // namespace semantic_mht_slam
