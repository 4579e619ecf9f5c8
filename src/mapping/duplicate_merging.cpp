#include "semantic_mht_slam/mapping/duplicate_merging.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace semantic_mht_slam {
namespace {

/// Places in the list of frames at which each landmark was seen, rising.
using Sightings = std::map<LandmarkId, std::vector<int>>;

constexpr std::size_t kNeighbours = 8;  // that tell how densely landmarks stand
constexpr double kBoxVariance = 0.25;   // between two boxes of one object, in variances of the detector

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

/// Probability that an object is seen in a frame between its first and its last.
double seenProb(const std::vector<int>& frames) {
  return (static_cast<double>(frames.size()) + 1.0) / (frames.back() - frames.front() + 1 + 2.0);
}

/// Evidence that `rare` is a second name of `common`, log odds: binomial likelihoods of being seen together.
double logOddsOfOneObject(const DuplicateConfig& config, const std::vector<int>& rare, const std::vector<int>& common) {
  const double seen_prob = seenProb(common);
  double log_odds = config.log_prior_odds;
  for (const int frame : rare) {
    if (frame < common.front() || frame > common.back()) continue;
    const bool is_together = std::binary_search(common.begin(), common.end(), frame);
    log_odds +=
        is_together ? std::log(config.split_prob / seen_prob) : std::log((1.0 - config.split_prob) / (1.0 - seen_prob));
  }
  return log_odds;
}

/// Landmarks a square metre around one of them, by the distance to its k-th neighbour (Loftsgaarden and Quesenberry,
/// A nonparametric estimate of a multivariate density function, 1965).
double densityAround(const MixtureLandmark& landmark, const std::vector<MixtureLandmark>& landmarks) {
  std::vector<double> distances_sq;
  for (const MixtureLandmark& other : landmarks) {
    distances_sq.push_back((other.position.mean_m - landmark.position.mean_m).head<2>().squaredNorm());
  }
  const std::size_t k = std::min(kNeighbours, distances_sq.size() - 1);
  std::nth_element(distances_sq.begin(), distances_sq.begin() + static_cast<std::ptrdiff_t>(k), distances_sq.end());
  return std::max(1.0, static_cast<double>(k) - 1.0) / (M_PI * distances_sq[k]);
}

/// Evidence that `rare` is a second box, of another class, that the detector draws around `common`, log odds: the box
/// stands nearer to it than another object would by chance, and hardly any frame shows it alone.
double logOddsOfSecondBox(double box_prob, const Eigen::Vector3d& d, const Eigen::Matrix3d& cov_m2,
                          double density_per_m2, const std::vector<int>& rare, const std::vector<int>& common) {
  const Eigen::Matrix2d planar_m2 = cov_m2.topLeftCorner<2, 2>();
  double log_odds = std::log(box_prob) - 0.5 * d.head<2>().dot(planar_m2.llt().solve(d.head<2>())) -
                    std::log(2.0 * M_PI) - 0.5 * std::log(planar_m2.determinant()) - std::log(density_per_m2);
  const double seen_prob = seenProb(common);
  for (const int frame : rare) {
    const bool is_together = std::binary_search(common.begin(), common.end(), frame);
    log_odds += is_together ? std::log((1.0 - box_prob) / seen_prob) : std::log(box_prob / (1.0 - seen_prob));
  }
  return log_odds;
}

/// Evidence that `rare` is `common` once more, log odds; none where they do not stand together.
std::optional<double> logOddsOfSame(const DuplicateConfig& config, double box_prob, const MixtureLandmark& rare,
                                    const MixtureLandmark& common, const Eigen::Matrix3d& detector_cov_m2,
                                    const Sightings& sightings, const std::vector<MixtureLandmark>& landmarks) {
  const bool is_of_class = rare.mostLikelyClass() == common.mostLikelyClass();
  const Eigen::Vector3d d = rare.position.mean_m - common.position.mean_m;
  const Eigen::Matrix3d cov_m2 =
      rare.position.cov_m2 + common.position.cov_m2 + (is_of_class ? 1.0 : kBoxVariance) * detector_cov_m2;
  if (d.dot(cov_m2.llt().solve(d)) >= config.gate_mahalanobis_sq) return std::nullopt;
  const std::vector<int>& in_rare = sightings.at(rare.id);
  const std::vector<int>& in_common = sightings.at(common.id);
  if (is_of_class) return logOddsOfOneObject(config, in_rare, in_common);
  return logOddsOfSecondBox(box_prob, d, cov_m2, densityAround(common, landmarks), in_rare, in_common);
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

std::vector<SameLandmark> mergeDuplicates(const DuplicateConfig& config, double box_prob,
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
      const auto log_odds = logOddsOfSame(config, box_prob, rare, common, detector_cov, sightings, landmarks);
      if (!log_odds || *log_odds <= best || seen.excludes(names[order[r]], names[order[c]])) continue;
      best = *log_odds;
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
