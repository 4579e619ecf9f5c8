#include "semantic_mht_slam/mapping/earlier_map.h"

namespace semantic_mht_slam {

void describe(MapAlignmentConfig& config, Fields& fields) {
  fields.add("enabled", config.enabled,
             "Whether hypotheses branch over alignments with an earlier map (the paper: false).");
  fields.add("first", config.first_m, "m", {0.0, 1000.0},
             "Distance in a submap after which alignments are looked for.");
  fields.add("retry", config.retry_m, "m", {0.1, 1000.0}, "They are looked for again after this, while there is none.");
  fields.add("min_landmarks", config.min_landmarks, "", {3, 1000}, "But not with fewer settled landmarks.");
  fields.add("max_landmarks", config.max_landmarks, "", {3, 1000}, "The nearest ones are used; bounds the time.");
  fields.add("radius", config.radius_m, "m", {1.0, 1000.0}, "Landmarks further from the vehicle are not used.");
  fields.add("log_prior_odds", config.log_prior_odds, "nats", {-100.0, 100.0},
             "Prior log odds of a place that the earlier map shows against one that it does not.");
  fields.add("max_log_evidence", config.max_log_evidence, "nats", {0.0, 1000.0},
             "What the first look counts at most, so that what is seen afterwards decides.");
  fields.add("accept_prob", config.accept_prob, "", {0.5, 0.999999},
             "Summed weight of the hypotheses that agree from which on an alignment is believed.");
  fields.add("min_matches", config.min_matches, "", {3, 1000}, "An alignment with fewer landmarks is not believed.");
}

}  // namespace semantic_mht_slam
