#pragma once

#include "semantic_mht_slam/common/config.h"

namespace semantic_mht_slam {

/// How the published `map -> odom` follows a new correction.
enum class CorrectionPolicy {
  kJump,     ///< at once
  kLimited,  ///< by a bounded speed of the robot in the map
};

/// What may change while the node runs, because no estimate depends on it. The names are those of cfg/SlamNodeLive.cfg.
struct LiveConfig {
  CorrectionPolicy correction = CorrectionPolicy::kJump;
  double correction_speed_m_s = 1.0;
  double correction_turn_rate_rad_s = 0.1;
  double landmark_min_existence_prob = 0.5;
  double landmark_sigmas = 2.0;
  bool landmark_labels = false;
  bool refused_closures = false;
};

void describe(LiveConfig& config, Fields& fields);

/// Names of the policies, as in parameters.
const std::vector<std::pair<std::string, CorrectionPolicy>>& correctionPolicies();

}  // namespace semantic_mht_slam
