#include "expected_landmarks.h"

#include <algorithm>

#include "semantic_mht_slam/common/log_math.h"

namespace semantic_mht_slam {
namespace {

constexpr double kHiddenOrNot = 0.5;       // whether an expected landmark is in sight is not known
constexpr double kMinExistence = 0.5;      // of earlier landmarks that are expected
constexpr double kMinObservations = 0.25;  // of theirs, in those of the average landmark

}  // namespace

double averageObservations(const std::vector<MixtureLandmark>& landmarks) {
  double sum = 0.0;
  for (const MixtureLandmark& landmark : landmarks) sum += landmark.observations;
  return landmarks.empty() ? 0.0 : sum / static_cast<double>(landmarks.size());
}

bool isExpected(const MixtureLandmark& earlier, double average_observations) {
  return earlier.existence_prob >= kMinExistence && earlier.observations >= kMinObservations * average_observations;
}

HypothesisLandmark expectedLandmark(const MixtureLandmark& earlier, int index, const Gaussian3& position,
                                    double driven_m, const ClassTable& classes, const RegistrationConfig& config) {
  auto landmark = std::make_shared<TrackedLandmark>(trackedFrom(earlier));
  landmark->position = position;
  landmark->is_from_earlier_submap = true;
  landmark->updated_at_m = driven_m;
  landmark->earlier = index;
  landmark->is_expected = true;
  const bool is_static = classes[earlier.mostLikelyClass()].is_static;
  const double match_prob = is_static ? config.static_match_prob : config.movable_match_prob;
  Existence existence;
  existence.log_odds = logit(std::clamp(earlier.existence_prob * match_prob, 0.001, 0.999));
  existence.visible_prob = kHiddenOrNot;
  return {std::move(landmark), existence};
}

}  // namespace semantic_mht_slam
