#pragma once

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/place/pair_descriptor.h"
#include "semantic_mht_slam/place/paper_chain.h"

namespace semantic_mht_slam {

/// Which earlier keyframes are verified geometrically.
enum class PlaceChain {
  kPairDistance,  ///< the most alike by `describePairs`, inside the drift gate
  kPaper,         ///< those that `PaperChain` proposes
};

/// Parameters of `PlaceRecognizer`.
struct PlaceConfig {
  PlaceChain chain = PlaceChain::kPairDistance;
  double recent_m = 80.0;
  bool drift_gate = true;
  double gate_base_m = 15.0;
  double gate_per_driven_m = 0.04;
  int max_compared = 400;
  int max_candidates = 5;
  double min_descriptor_score = 0.2;
  double full_residual_m = 0.35;
  double movable_weight = 0.7;
  int min_inliers = 6;
  int min_classes = 2;
  double min_spread_m = 2.0;
  double max_stddev_m = 1.0;
  double max_stddev_rad = 0.05;
  double min_share = 0.25;
  double min_log_evidence = 5.0;
  double supported_score = 7.0;
  double lone_score = 10.0;
  double far_factor = 2.0;
  double rival_ratio = 0.7;
  double agree_m = 2.0;
  double agree_rad = 0.06;
  double support_reach_m = 60.0;
  PairDescriptorConfig descriptor;
  PaperChainConfig paper;
};

void describe(PlaceConfig& config, Fields& fields);

}  // namespace semantic_mht_slam
