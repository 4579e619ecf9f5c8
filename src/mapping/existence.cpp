#include "semantic_mht_slam/mapping/existence.h"

#include <algorithm>
#include <cmath>

namespace semantic_mht_slam {

double predictedVisibility(double visible_prob, double switch_prob) {
  return visible_prob * (1.0 - switch_prob) + (1.0 - visible_prob) * switch_prob;
}

double applyMiss(Existence& existence, double detection_prob, double switch_prob) {
  const double visible = predictedVisibility(existence.visible_prob, switch_prob);
  const double likelihood = 1.0 - visible * detection_prob;
  existence.visible_prob = visible * (1.0 - detection_prob) / likelihood;
  existence.log_odds += std::log(likelihood);
  return likelihood;
}

void applyHit(Existence& existence, double detection_prob, double switch_prob, double log_density_ratio,
              double max_log_odds) {
  const double visible = predictedVisibility(existence.visible_prob, switch_prob);
  const double evidence = std::log(visible * detection_prob) + log_density_ratio;
  existence.log_odds = std::min(max_log_odds, existence.log_odds + evidence);
  existence.visible_prob = 1.0;
}

}  // namespace semantic_mht_slam
