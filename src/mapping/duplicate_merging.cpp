#include "semantic_mht_slam/mapping/duplicate_merging.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

/// Places in the list of frames at which each landmark was seen, rising.
using Sightings = std::map<LandmarkId, std::vector<int>>;

Sightings collectSightings(const std::vector<FusedAssociations>& associations) {
  Sightings sightings;
  for (std::size_t k = 0; k < associations.size(); ++k) {
    for (const LandmarkId id : associations[k].landmark_of_measurement) {
      std::vector<int>& frames = sightings[id];
      const int frame = static_cast<int>(k);
      if (frames.empty() || frames.back() != frame) frames.push_back(frame);
    }
  }
  return sightings;
}

/// Evidence that `rare` is a second name of `common`, log odds: binomial likelihoods of being seen together.
double logOddsOfOneObject(const DuplicateConfig& config, const std::vector<int>& rare, const std::vector<int>& common) {
  const int first = common.front();
  const int last = common.back();
  const double seen_prob = (static_cast<double>(common.size()) + 1.0) / (last - first + 1 + 2.0);
  double log_odds = config.log_prior_odds;
  for (const int frame : rare) {
    if (frame < first || frame > last) continue;
    const bool is_together = std::binary_search(common.begin(), common.end(), frame);
    log_odds +=
        is_together ? std::log(config.split_prob / seen_prob) : std::log((1.0 - config.split_prob) / (1.0 - seen_prob));
  }
  return log_odds;
}

bool standTogether(const DuplicateConfig& config, const MixtureLandmark& a, const MixtureLandmark& b,
                   const Eigen::Matrix3d& detector_cov) {
  if (a.mostLikelyClass() != b.mostLikelyClass()) return false;
  const Eigen::Vector3d d = a.position.mean_m - b.position.mean_m;
  const Eigen::Matrix3d cov = a.position.cov_m2 + b.position.cov_m2 + detector_cov;
  return d.dot(cov.llt().solve(d)) < config.gate_mahalanobis_sq;
}

/// Product of the two Gaussians and of the class probabilities.
void absorb(MixtureLandmark& survivor, const MixtureLandmark& merged) {
  const Eigen::Matrix3d a = survivor.position.cov_m2.inverse();
  const Eigen::Matrix3d b = merged.position.cov_m2.inverse();
  const Eigen::Matrix3d cov = (a + b).inverse();
  survivor.position.mean_m = cov * (a * survivor.position.mean_m + b * merged.position.mean_m);
  survivor.position.cov_m2 = 0.5 * (cov + cov.transpose());
  survivor.components = {{1.0, survivor.position}};
  const ClassProbs product = survivor.class_probs * merged.class_probs;
  if (product.sum() > 0.0) survivor.class_probs = product / product.sum();
  survivor.existence_prob = std::max(survivor.existence_prob, merged.existence_prob);
  survivor.observations += merged.observations;
  survivor.first_submap = std::min(survivor.first_submap, merged.first_submap);
  survivor.last_submap = std::max(survivor.last_submap, merged.last_submap);
}

}  // namespace

void describe(DuplicateConfig& config, Fields& fields) {
  fields.add("merge", config.merge, "Whether landmarks that turn out to be one object are merged (the paper: false).");
  fields.add("gate", config.gate_mahalanobis_sq, "", {0.0, 1000.0},
             "Largest squared Mahalanobis distance of two names.");
  fields.add("split_prob", config.split_prob, "", {0.001, 0.9},
             "Probability that the detector splits an object in two.");
  fields.add("log_prior_odds", config.log_prior_odds, "nats", {-100.0, 100.0},
             "Prior log odds that two landmarks of a class inside the gate are one object.");
}

std::vector<SameLandmark> mergeDuplicates(const DuplicateConfig& config,
                                          const std::vector<FusedAssociations>& associations, const SideBySide& seen,
                                          const std::function<Eigen::Matrix3d(ClassIndex)>& detectorCov,
                                          std::vector<MixtureLandmark>& landmarks) {
  std::vector<SameLandmark> duplicates;
  if (!config.merge) return duplicates;
  const Sightings sightings = collectSightings(associations);
  std::vector<std::size_t> order;  // rarely seen ones first: they are merged into the others
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (sightings.count(landmarks[i].id) > 0) order.push_back(i);
  }
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return landmarks[a].observations < landmarks[b].observations; });
  std::vector<std::vector<LandmarkId>> names;  // of each landmark, with what it took in
  for (const MixtureLandmark& landmark : landmarks) names.push_back({landmark.id});
  std::vector<char> is_gone(landmarks.size(), 0);
  for (std::size_t r = 0; r < order.size(); ++r) {
    MixtureLandmark& rare = landmarks[order[r]];
    const Eigen::Matrix3d detector_cov = detectorCov(rare.mostLikelyClass());
    double best = 0.0;
    std::size_t survivor = landmarks.size();
    for (std::size_t c = r + 1; c < order.size(); ++c) {
      const MixtureLandmark& common = landmarks[order[c]];
      if (!standTogether(config, rare, common, detector_cov)) continue;
      if (seen.excludes(names[order[r]], names[order[c]])) continue;
      const double log_odds = logOddsOfOneObject(config, sightings.at(rare.id), sightings.at(common.id));
      if (log_odds <= best) continue;
      best = log_odds;
      survivor = order[c];
    }
    if (survivor == landmarks.size()) continue;
    absorb(landmarks[survivor], rare);
    names[survivor].insert(names[survivor].end(), names[order[r]].begin(), names[order[r]].end());
    duplicates.push_back({rare.id, landmarks[survivor].id});
    is_gone[order[r]] = 1;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < landmarks.size(); ++i) {
    if (is_gone[i] == 0) {
      if (kept != i) landmarks[kept] = std::move(landmarks[i]);
      ++kept;
    }
  }
  landmarks.resize(kept);
  return duplicates;
}

}  // namespace semantic_mht_slam
