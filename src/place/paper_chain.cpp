#include "semantic_mht_slam/place/paper_chain.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include "semantic_mht_slam/place/laplacian.h"

namespace semantic_mht_slam {

void describe(PaperChainConfig& config, Fields& fields) {
  fields.add("similar_submaps", config.similar_submaps, "", {1, 100000}, "Most similar submaps that are searched.");
  fields.add("max_divergence", config.max_divergence, "", {0.0, kMaxDivergence},
             "Largest Jensen-Shannon divergence of the class histograms of similar submaps.");
  fields.add("scenes_per_submap", config.scenes_per_submap, "", {1, 100000}, "Scenes of each that are scored.");
  fields.add("max_scene_distance", config.max_scene_distance, "", {0.0, 1.5},
             "Largest Euclidean distance of the class histograms of two scenes.");
  fields.add("min_score", config.min_score, "", {-1.0, 2.0}, "Least sum of topology and landmark score that passes.");
  fields.group("covisibility", config.covisibility);
  fields.group("scene", config.scene);
  fields.group("filter", config.filter);
}

PaperChain::PaperChain(const PaperChainConfig& config, int classes)
    : config_(config),
      classes_(classes),
      graph_(config.covisibility),
      submap_index_(HistogramMetric::kJensenShannon, classes),
      filter_(config.filter) {}

Eigen::MatrixXd PaperChain::laplacianOf(const Scene& scene) const {
  return classLaplacian(scene, classes_, graph_, config_.covisibility);
}

void PaperChain::add(const ClassHistogram& submap_histogram, const std::vector<Keyframe>& keyframes) {
  PlacesOfSubmap submap{
      std::numeric_limits<double>::infinity(), {}, HistogramIndex(HistogramMetric::kEuclidean, classes_)};
  for (const Keyframe& keyframe : keyframes) graph_.addKeyframe(keyframe.scene);
  for (const Keyframe& keyframe : keyframes) {
    submap.begin_m = std::min(submap.begin_m, keyframe.driven_m);
    submap.scenes.insert(classHistogram(keyframe.scene, classes_));
    submap.places.push_back(
        {places_++, keyframe.frame, keyframe.submap, keyframe.driven_m, keyframe.scene, laplacianOf(keyframe.scene)});
  }
  submap_index_.insert(submap_histogram);
  submaps_.push_back(std::move(submap));
}

PaperCandidate PaperChain::scorePair(const Place& place, const Keyframe& keyframe,
                                     const Eigen::MatrixXd& laplacian) const {
  PaperCandidate candidate;
  candidate.place = place.number;
  candidate.frame = place.frame;
  candidate.submap = place.submap;
  candidate.topology_score = laplacianCorrelation(laplacian, place.laplacian);
  const double lacking = config_.min_score - candidate.topology_score;
  if (lacking > 1.0) {
    candidate.refusal = PlaceRefusal::kUnlikeTopology;
  } else if (sceneScoreBound(keyframe.scene, place.scene, config_.scene) < lacking) {
    candidate.refusal = PlaceRefusal::kUnlikeScene;
  } else {
    candidate.scene_score = sceneScore(keyframe.scene, place.scene, config_.scene);
    if (candidate.score() < config_.min_score) candidate.refusal = PlaceRefusal::kUnlikeScene;
  }
  return candidate;
}

std::vector<PaperCandidate> PaperChain::scoreScenesOf(const PlacesOfSubmap& submap, double divergence,
                                                      const Keyframe& keyframe,
                                                      const Eigen::MatrixXd& laplacian) const {
  const double latest_m = keyframe.driven_m - config_.recent_m;
  const auto scenes = submap.scenes.nearest(classHistogram(keyframe.scene, classes_), config_.scenes_per_submap,
                                            config_.max_scene_distance,
                                            [&](std::size_t i) { return submap.places[i].driven_m <= latest_m; });
  std::vector<PaperCandidate> candidates;
  for (const HistogramMatch& scene : scenes) {
    candidates.push_back(scorePair(submap.places[scene.index], keyframe, laplacian));
    candidates.back().histogram_divergence = divergence;
    candidates.back().scene_distance = scene.distance;
  }
  return candidates;
}

std::vector<PaperCandidate> PaperChain::query(const Keyframe& keyframe, const ClassHistogram& submap_histogram) {
  const double latest_m = keyframe.driven_m - config_.recent_m;
  const auto laplacianOfQuery = [&] {  // that of the newest submap's keyframes was made when they came in
    if (submaps_.empty()) return laplacianOf(keyframe.scene);
    const std::vector<Place>& places = submaps_.back().places;
    const auto own = std::find_if(places.begin(), places.end(), [&](const Place& place) {
      return place.submap == keyframe.submap && place.frame == keyframe.frame;
    });
    return own != places.end() ? own->laplacian : laplacianOf(keyframe.scene);
  };
  const auto similar = submap_index_.nearest(submap_histogram, config_.similar_submaps, config_.max_divergence,
                                             [&](std::size_t i) { return submaps_[i].begin_m <= latest_m; });
  const Eigen::MatrixXd laplacian = laplacianOfQuery();
  std::vector<PaperCandidate> candidates;
  for (const HistogramMatch& match : similar) {
    auto scored = scoreScenesOf(submaps_[match.index], match.distance, keyframe, laplacian);
    std::move(scored.begin(), scored.end(), std::back_inserter(candidates));
  }
  std::sort(candidates.begin(), candidates.end(), [](const PaperCandidate& a, const PaperCandidate& b) {
    return std::make_tuple(-a.score(), a.frame) < std::make_tuple(-b.score(), b.frame);
  });
  const double loop_prob = filter_.update(!candidates.empty() && candidates.front().refusal == PlaceRefusal::kNone);
  for (PaperCandidate& candidate : candidates) {
    candidate.loop_prob = loop_prob;
    const bool is_proposed = candidate.refusal == PlaceRefusal::kNone;
    if (is_proposed && !filter_.believes()) candidate.refusal = PlaceRefusal::kFilter;
  }
  return candidates;
}

}  // namespace semantic_mht_slam
