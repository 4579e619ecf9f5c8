#include "semantic_mht_slam/app/live_config.h"

namespace semantic_mht_slam {

const std::vector<std::pair<std::string, CorrectionPolicy>>& correctionPolicies() {
  static const std::vector<std::pair<std::string, CorrectionPolicy>> kPolicies = {
      {"jump", CorrectionPolicy::kJump}, {"limited", CorrectionPolicy::kLimited}};
  return kPolicies;
}

void describe(LiveConfig& config, Fields& fields) {
  fields.add<CorrectionPolicy>("correction", config.correction, correctionPolicies(),
                               "How the published map -> odom follows a new correction: at once, or at a bounded "
                               "speed of the robot in the map.");
  fields.add("correction_speed", config.correction_speed_m_s, "m/s", {0.001, 1000.0},
             "Speed of that for the position; only with 'limited'.");
  fields.add("correction_turn_rate", config.correction_turn_rate_rad_s, "rad/s", {0.0001, 100.0},
             "Speed of that for the heading; only with 'limited'.");
  fields.add("landmark_min_existence", config.landmark_min_existence_prob, "", {0.0, 1.0},
             "Landmarks that exist with less probability are not drawn in markers/landmarks; the map keeps them.");
  fields.add("landmark_sigmas", config.landmark_sigmas, "", {0.1, 10.0},
             "Standard deviations from the centre to the surface of a landmark's ellipsoid.");
  fields.add("landmark_labels", config.landmark_labels,
             "Class and id at every landmark, in yellow with the leading alternative's weight if it is undecided.");
  fields.add("refused_closures", config.refused_closures,
             "Loop closures that were looked at and refused are drawn as well in markers/loops.");
}

}  // namespace semantic_mht_slam
