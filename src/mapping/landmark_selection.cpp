#include "landmark_selection.h"

#include <algorithm>
#include <tuple>

namespace semantic_mht_slam {
namespace {

bool isSettled(const HypothesisLandmark& landmark) {
  return !landmark->is_expected && landmark->observations >= kSettledObservations && landmark.existence.log_odds > 0.0;
}

}  // namespace

std::vector<const TrackedLandmark*> nearestLandmarks(const MapHypothesis& leaf, const Eigen::Vector3d& center_m,
                                                     double radius_m, int count) {
  std::vector<std::tuple<double, LandmarkId, const TrackedLandmark*>> near;
  for (const HypothesisLandmark& landmark : leaf.landmarks) {
    const double distance_m = (landmark->position.mean_m - center_m).norm();
    if (isSettled(landmark) && distance_m < radius_m) {
      near.emplace_back(distance_m, landmark->id, landmark.tracked.get());
    }
  }
  std::sort(near.begin(), near.end());
  near.resize(std::min(near.size(), static_cast<std::size_t>(count)));
  std::vector<const TrackedLandmark*> result;
  for (const auto& [distance_m, id, landmark] : near) result.push_back(landmark);
  return result;
}

std::vector<const TrackedLandmark*> mostSeenLandmarks(const MapHypothesis& leaf, int count) {
  std::vector<std::tuple<int, LandmarkId, const TrackedLandmark*>> seen;
  for (const HypothesisLandmark& landmark : leaf.landmarks) {
    const bool is_of_submap = isSettled(landmark) && !landmark->is_from_earlier_submap;
    if (is_of_submap) seen.emplace_back(-landmark->observations, landmark->id, landmark.tracked.get());
  }
  std::sort(seen.begin(), seen.end());
  seen.resize(std::min(seen.size(), static_cast<std::size_t>(count)));
  std::vector<const TrackedLandmark*> result;
  for (const auto& [observations, id, landmark] : seen) result.push_back(landmark);
  return result;
}

}  // namespace semantic_mht_slam
