#include "graph_state.h"

#include <algorithm>
#include <iterator>

#include <Eigen/LU>

namespace semantic_mht_slam {

std::int64_t GraphState::keptNumber(std::int64_t landmark) const {
  for (auto found = merged_landmarks.find(landmark); found != merged_landmarks.end();
       found = merged_landmarks.find(landmark)) {
    landmark = found->second;
  }
  return landmark;
}

void GraphState::addSighting(const LandmarkSighting& sighting) {
  const int newest = static_cast<int>(submaps.size()) - 1;
  const std::int64_t number = keptNumber(sighting.landmark);
  const auto [entry, is_new] = landmarks.try_emplace(number);
  LandmarkState& landmark = entry->second;
  if (is_new) {
    landmark.anchor = newest;
    landmark.position_m = sighting.position_m;
  }
  if (is_new || landmark.sightings.back().submap != newest) submaps[newest].landmarks.push_back(number);
  landmark.sightings.push_back(
      {newest, std::make_unique<PointCost<3>>(sighting.position_m, sighting.cov_m2.inverse())});
}

std::vector<int> GraphState::mergeLandmarks(std::int64_t merged, std::int64_t survivor) {
  LandmarkState& kept = landmarks.at(survivor);
  LandmarkState& given_up = landmarks.at(merged);
  for (const SightingFactor& sighting : given_up.sightings) {
    auto& numbers = submaps[sighting.submap].landmarks;
    numbers.erase(std::remove(numbers.begin(), numbers.end(), merged), numbers.end());
    if (std::find(numbers.begin(), numbers.end(), survivor) == numbers.end()) numbers.push_back(survivor);
  }
  if (given_up.anchor < kept.anchor) {
    kept.anchor = given_up.anchor;
    kept.position_m = given_up.position_m;
  }
  std::vector<SightingFactor> sightings;
  std::merge(std::make_move_iterator(kept.sightings.begin()), std::make_move_iterator(kept.sightings.end()),
             std::make_move_iterator(given_up.sightings.begin()), std::make_move_iterator(given_up.sightings.end()),
             std::back_inserter(sightings),
             [](const SightingFactor& a, const SightingFactor& b) { return a.submap < b.submap; });
  kept.sightings = std::move(sightings);
  landmarks.erase(merged);
  merged_landmarks.emplace(merged, survivor);
  std::vector<int> seen_by;
  for (const SightingFactor& sighting : kept.sightings) {
    if (seen_by.empty() || seen_by.back() != sighting.submap) seen_by.push_back(sighting.submap);
  }
  return seen_by;
}

}  // namespace semantic_mht_slam
