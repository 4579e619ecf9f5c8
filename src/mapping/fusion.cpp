#include "semantic_mht_slam/mapping/fusion.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "semantic_mht_slam/common/log_math.h"

namespace semantic_mht_slam {
namespace {

constexpr double kSamePlaceSigmas = 0.5;

struct Contribution {
  double weight;
  const HypothesisLandmark* landmark;
};

/// Whether two components say the same of where a landmark is: hypotheses that differ elsewhere correct the pose a
/// little differently.
bool coincide(const MixtureComponent& a, const MixtureComponent& b) {
  const Eigen::Vector3d d = a.position.mean_m - b.position.mean_m;
  const Eigen::Vector3d variance_m2 = a.position.cov_m2.diagonal().cwiseMin(b.position.cov_m2.diagonal());
  return (d.array().square() <= kSamePlaceSigmas * kSamePlaceSigmas * variance_m2.array()).all();
}

/// Makes one component of each and the heavier one that it coincides with. The moments of the mixture stay.
std::vector<MixtureComponent> withoutCoinciding(const std::vector<MixtureComponent>& components) {
  std::vector<MixtureComponent> kept;
  for (const MixtureComponent& component : components) {
    const auto same =
        std::find_if(kept.begin(), kept.end(), [&](const auto& other) { return coincide(other, component); });
    if (same == kept.end()) {
      kept.push_back(component);
    } else {
      *same = {same->weight + component.weight, moments({*same, component})};
    }
  }
  return kept;
}

void sortByWeight(std::vector<MixtureComponent>& components) {
  std::stable_sort(components.begin(), components.end(),
                   [](const auto& a, const auto& b) { return a.weight > b.weight; });
}

std::vector<MixtureComponent> makeComponents(const std::vector<Contribution>& contributions, double total) {
  std::vector<MixtureComponent> components;
  for (const auto& [weight, landmark] : contributions) {
    const auto same = std::find_if(components.begin(), components.end(),
                                   [&, tracked = landmark->tracked.get()](const auto& component) {
                                     return component.position.mean_m == tracked->position.mean_m &&
                                            component.position.cov_m2 == tracked->position.cov_m2;
                                   });
    if (same == components.end()) {
      components.push_back({weight / total, (*landmark)->position});
    } else {
      same->weight += weight / total;
    }
  }
  sortByWeight(components);
  components = withoutCoinciding(components);
  sortByWeight(components);
  return components;
}

MixtureLandmark fuse(LandmarkId id, const std::vector<Contribution>& contributions) {
  MixtureLandmark fused;
  fused.id = id;
  double total = 0.0;
  for (const Contribution& contribution : contributions) total += contribution.weight;
  fused.components = makeComponents(contributions, total);
  fused.position = moments(fused.components);
  const TrackedLandmark& likeliest = **contributions.front().landmark;  // leaves come by falling weight
  fused.class_probs = ClassProbs::Zero(likeliest.class_probs.size());
  for (const auto& [weight, landmark] : contributions) {
    fused.class_probs += weight / total * (*landmark)->class_probs;
    fused.existence_prob += weight * logistic(landmark->existence.log_odds);
  }
  fused.observations = likeliest.observations;
  fused.first_submap = likeliest.first_submap;
  fused.last_submap = likeliest.last_submap;
  return fused;
}

}  // namespace

std::vector<MixtureLandmark> fuseHypotheses(const std::vector<MapHypothesis>& leaves) {
  std::map<LandmarkId, std::vector<Contribution>> contributions;
  for (const MapHypothesis& leaf : leaves) {
    for (const HypothesisLandmark& landmark : leaf.landmarks) {
      if (landmark->is_expected) continue;  // not seen here
      contributions[landmark->id].push_back({std::exp(leaf.log_weight), &landmark});
    }
  }
  std::vector<MixtureLandmark> fused;
  for (const auto& [id, list] : contributions) fused.push_back(fuse(id, list));
  return fused;
}

std::vector<FusedAssociations> fuseAssociations(const std::vector<MapHypothesis>& leaves) {
  // Votes of a record count for its ancestors too; leaves share them, so each is visited once a leaf.
  std::map<std::size_t, std::vector<std::map<LandmarkId, double>>> votes;
  std::map<std::size_t, PoseOffset> offsets;
  for (const MapHypothesis& leaf : leaves) {
    const double weight = std::exp(leaf.log_weight);
    for (const AssociationRecord* record = leaf.history.get(); record != nullptr; record = record->previous.get()) {
      auto& frame = votes[record->frame];
      frame.resize(record->landmark_of_measurement.size());
      offsets.emplace(record->frame, record->offset);  // the first leaf's, which is the likeliest
      for (std::size_t i = 0; i < frame.size(); ++i) frame[i][record->landmark_of_measurement[i]] += weight;
    }
  }
  std::vector<FusedAssociations> fused;
  for (const auto& [frame, measurements] : votes) {
    fused.push_back({frame, {}, offsets.at(frame)});
    for (const auto& candidates : measurements) {
      const auto best = std::max_element(candidates.begin(), candidates.end(),
                                         [](const auto& a, const auto& b) { return a.second < b.second; });
      fused.back().landmark_of_measurement.push_back(best->first);
    }
  }
  return fused;
}

}  // namespace semantic_mht_slam
