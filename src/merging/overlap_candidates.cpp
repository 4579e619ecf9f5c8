#include "overlap_candidates.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "semantic_mht_slam/place/scene_alignment.h"

namespace semantic_mht_slam {
namespace {

/// Two windows, and how alike they look.
struct AlikeWindows {
  double similarity = 0.0;
  std::size_t a = 0;
  std::size_t b = 0;
};

bool isMoreAlike(const AlikeWindows& x, const AlikeWindows& y) {
  if (x.similarity != y.similarity) return x.similarity > y.similarity;
  return x.b != y.b ? x.b < y.b : x.a < y.a;
}

std::vector<AlikeWindows> alikeWindows(const MergeMap& a, const MergeMap& b, double min_similarity,
                                       const MergeConfig& config) {
  std::vector<AlikeWindows> result;
  for (std::size_t in_b = 0; in_b < b.windows().size(); ++in_b) {
    std::vector<AlikeWindows> alike;
    for (std::size_t in_a = 0; in_a < a.windows().size(); ++in_a) {
      const double similarity = descriptorSimilarity(a.windows()[in_a].descriptor, b.windows()[in_b].descriptor);
      if (similarity >= min_similarity) alike.push_back({similarity, in_a, in_b});
    }
    const std::size_t count = std::min(alike.size(), static_cast<std::size_t>(config.candidates_per_window));
    std::partial_sort(alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(count), alike.end(), isMoreAlike);
    result.insert(result.end(), alike.begin(), alike.begin() + static_cast<std::ptrdiff_t>(count));
  }
  std::sort(result.begin(), result.end(), isMoreAlike);
  if (static_cast<int>(result.size()) > config.candidates_per_pair) {
    result.resize(static_cast<std::size_t>(config.candidates_per_pair));
  }
  return result;
}

/// A rank that one scene with many landmarks cannot reach alone.
double weightOf(const OverlapCandidate& candidate, const MergeConfig& config) {
  return std::min(candidate.log_evidence, config.max_log_odds * static_cast<double>(candidate.pairs));
}

OverlapAnchor anchorOf(const OverlapCandidate& candidate) {
  return {candidate.a, candidate.b, candidate.T_a_b, candidate.log_evidence};
}

}  // namespace

std::vector<OverlapCandidate> findCandidates(const MergeMap& a, const MergeMap& b, const MergeSettings& settings,
                                             const MergeConfig& config) {
  const PlaceUnits units(settings.range_factor);
  const PlaceConfig& place = settings.slam.back_end.place;
  const RegistrationConfig registration = units.toPlaces(settings.slam.registration);
  std::vector<OverlapCandidate> candidates;
  for (const AlikeWindows& alike : alikeWindows(a, b, place.min_descriptor_score, config)) {
    const MapWindow& window_a = a.windows()[alike.a];
    const MapWindow& window_b = b.windows()[alike.b];
    const Scene scene_a = units.toPlaces(window_a.scene);
    const Scene scene_b = units.toPlaces(window_b.scene);
    const auto alignments = alignScenes(scene_b, scene_a, settings.classes, registration, place);
    for (std::size_t m = 0; m < alignments.size() && m < static_cast<std::size_t>(config.modes_per_candidate); ++m) {
      const SceneAlignment& alignment = alignments[m];
      if (static_cast<int>(alignment.mode.pairs.size()) < config.min_pairs) continue;
      if (alignment.spread_m < place.min_spread_m) continue;
      PlaceMatch match;
      match.T_match_query = alignment.mode.T_a_b;
      OverlapCandidate candidate{window_a.keyframe,
                                 window_b.keyframe,
                                 units.fromPlaces(match).T_match_query,
                                 alignment.mode.log_evidence,
                                 static_cast<int>(alignment.mode.pairs.size()),
                                 {}};
      for (const SceneObject& object : window_b.scene.objects) candidate.landmarks.push_back(object.landmark);
      candidates.push_back(std::move(candidate));
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(), [](const OverlapCandidate& x, const OverlapCandidate& y) {
    return x.log_evidence > y.log_evidence;
  });
  return candidates;
}

RegistrationPrior priorAt(KeyframeId b_keyframe, const OverlapAnchor& anchor, const MergeMap& a, const MergeMap& b,
                          const MergeSettings& settings) {
  const RevisitConfig& revisit = settings.slam.back_end.revisit;
  const KeyframeDrift drift = b.drift(anchor.b, b_keyframe);
  const Pose T_anchor_keyframe = b.map().T_map_keyframe(anchor.b).inverse() * b.map().T_map_keyframe(b_keyframe);
  RegistrationPrior prior;
  prior.T_a_b = a.map().T_map_keyframe(anchor.a) * anchor.T_a_b * T_anchor_keyframe;
  // The other map drifts over the same distance, too; the heading of the anchor is as good as a closure's.
  const double lever_m = T_anchor_keyframe.translation_m.head<2>().norm() * revisit.base_stddev_rad;
  const double xy_m = std::sqrt(revisit.base_stddev_m * revisit.base_stddev_m + 2.0 * drift.xy_m * drift.xy_m +
                                lever_m * lever_m + anchor.stddev_m * anchor.stddev_m);
  prior.stddev_xy_m = std::min<double>(revisit.max_stddev_m, xy_m);
  prior.stddev_z_m = prior.stddev_xy_m;
  prior.stddev_yaw_rad = std::hypot(revisit.base_stddev_rad, std::sqrt(2.0) * drift.yaw_rad);
  return prior;
}

bool agree(const OverlapAnchor& known, const OverlapAnchor& other, const MergeMap& a, const MergeMap& b,
           const MergeSettings& settings, const MergeConfig& config) {
  const RegistrationPrior by_known = priorAt(other.b, known, a, b, settings);
  const Pose by_other = a.map().T_map_keyframe(other.a) * other.T_a_b;
  const KeyframeDrift in_a = a.drift(known.a, other.a);
  const double xy_m = std::hypot(by_known.stddev_xy_m, std::min<double>(in_a.xy_m, by_known.stddev_xy_m));
  const double yaw_rad = std::hypot(by_known.stddev_yaw_rad, std::min(in_a.yaw_rad, by_known.stddev_yaw_rad));
  const double apart_m = (by_known.T_a_b.translation_m - by_other.translation_m).head<2>().norm();
  const double turned_rad = angularDistance(by_known.T_a_b.rotation, by_other.rotation);
  const double agree_m = config.agree_m * settings.range_factor;
  if (apart_m < agree_m && turned_rad < config.agree_rad) return true;
  const double gap = apart_m * apart_m / (xy_m * xy_m) + turned_rad * turned_rad / (yaw_rad * yaw_rad);
  return gap < config.confidence_gate;
}

std::vector<std::vector<OverlapCandidate>> consistentSets(std::vector<OverlapCandidate> candidates, const MergeMap& a,
                                                          const MergeMap& b, const MergeSettings& settings,
                                                          const MergeConfig& config) {
  const std::size_t count = candidates.size();
  std::vector<std::vector<std::size_t>> agreeing(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (!agree(anchorOf(candidates[i]), anchorOf(candidates[k]), a, b, settings, config)) continue;
      agreeing[i].push_back(k);
      agreeing[k].push_back(i);
    }
  }
  std::vector<bool> is_taken(count, false);
  std::vector<std::vector<OverlapCandidate>> sets;
  while (static_cast<int>(sets.size()) < config.max_hypotheses) {
    std::size_t best = count;
    double best_weight = 0.0;
    for (std::size_t i = 0; i < count; ++i) {
      if (is_taken[i]) continue;
      double weight = weightOf(candidates[i], config);
      std::set<KeyframeId> windows{candidates[i].b};  // each once: several ways to lay it are one witness
      for (const std::size_t k : agreeing[i]) {
        if (!is_taken[k] && windows.insert(candidates[k].b).second) weight += weightOf(candidates[k], config);
      }
      if (weight <= best_weight) continue;
      best = i;
      best_weight = weight;
    }
    if (best == count) break;
    std::vector<OverlapCandidate> set{candidates[best]};
    is_taken[best] = true;
    for (const std::size_t k : agreeing[best]) {
      if (is_taken[k]) continue;
      set.push_back(candidates[k]);
      is_taken[k] = true;
    }
    std::stable_sort(set.begin(), set.end(), [](const OverlapCandidate& x, const OverlapCandidate& y) {
      return x.log_evidence > y.log_evidence;
    });
    sets.push_back(std::move(set));
  }
  return sets;
}

}  // namespace semantic_mht_slam
