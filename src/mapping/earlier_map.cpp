#include "semantic_mht_slam/mapping/earlier_map.h"

#include <algorithm>

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
  fields.group("joint", config.joint);
}

void joinEarlierLandmarks(const std::vector<MergedLandmark>& found,
                          const std::function<const MixtureLandmark&(LandmarkId)>& earlier,
                          std::vector<MixtureLandmark>& landmarks, std::vector<MergedLandmark>& merged) {
  const auto withId = [&](LandmarkId id) {
    return std::find_if(landmarks.begin(), landmarks.end(), [&](const MixtureLandmark& l) { return l.id == id; });
  };
  for (const MergedLandmark& name : found) {
    const auto landmark = withId(name.merged);
    if (landmark == landmarks.end()) continue;               // was merged into another landmark of the submap
    if (withId(name.survivor) != landmarks.end()) continue;  // the submap has it beside this one
    const MixtureLandmark& known = earlier(name.survivor);
    landmark->id = name.survivor;
    landmark->observations += known.observations;
    landmark->first_submap = std::min(landmark->first_submap, known.first_submap);
    landmark->existence_prob = std::max(landmark->existence_prob, known.existence_prob);
    const auto leadsBack = [&](const MergedLandmark& pair) { return pair.merged == name.survivor; };
    merged.erase(std::remove_if(merged.begin(), merged.end(), leadsBack), merged.end());
    merged.push_back(name);
  }
  std::sort(landmarks.begin(), landmarks.end(),
            [](const MixtureLandmark& a, const MixtureLandmark& b) { return a.id < b.id; });
}

}  // namespace semantic_mht_slam
