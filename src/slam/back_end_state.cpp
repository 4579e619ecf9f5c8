#include <algorithm>
#include <optional>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/map_state.h"
#include "semantic_mht_slam/slam/back_end.h"

namespace semantic_mht_slam {
namespace {

bool areEqual(const SceneObject& a, const SceneObject& b) {
  return a.position_m == b.position_m && a.cov_m2 == b.cov_m2 && a.class_index == b.class_index &&
         a.landmark == b.landmark;
}

/// What a keyframe sees, from the submap that it was cut from.
class SceneOfSubmap {
 public:
  SceneOfSubmap(const Submap& submap, const Pose& T_odom_keyframe, double floor_m)
      : submap_(submap), T_keyframe_submap_(T_odom_keyframe.inverse() * submap.T_odom_submap), floor_m_(floor_m) {}

  std::optional<SceneObject> find(LandmarkId id) const {
    const MixtureLandmark* landmark = findLandmark(id, submap_.landmarks);
    if (landmark == nullptr) return std::nullopt;
    return sceneObject(*landmark, T_keyframe_submap_, floor_m_);
  }

  /// Objects that the submap gives are written as their ids.
  void transfer(StateArchive& archive, std::vector<SceneObject>& objects) const {
    const std::size_t count = archive.count(objects.size());
    if (archive.isReading()) objects.assign(count, {});
    LandmarkId last = 0;
    for (SceneObject& object : objects) {
      const std::optional<SceneObject> known = archive.isReading() ? std::nullopt : find(object.landmark);
      bool is_known = known && areEqual(*known, object);
      LandmarkId step = object.landmark - last;
      archive(is_known, step);
      object.landmark = last += step;
      if (!is_known) {
        archive(object.position_m, object.cov_m2, object.class_index);
      } else if (archive.isReading()) {
        const std::optional<SceneObject> found = find(object.landmark);
        if (!found) StateArchive::fail("a scene shows a landmark that its submap lacks");
        object = *found;
      }
    }
  }

 private:
  const Submap& submap_;
  Pose T_keyframe_submap_;
  double floor_m_;
};

void requireIndex(int index, std::size_t size) {
  if (index < 0 || index >= static_cast<int>(size)) StateArchive::fail("a number names no keyframe or closure");
}

}  // namespace

/// Without the sightings, which are in the pose graph, and the scene.
void transfer(StateArchive& archive, MapKeyframe& keyframe) {
  archive(keyframe.frame, keyframe.stamp, keyframe.driven_m, keyframe.T_odom_base);
}

void transfer(StateArchive& archive, SubmapCheck& check) {
  auto& [first_keyframe, is_checked, evaluation] = check;
  auto& [features, good_prob, worth_checking] = evaluation;
  archive(first_keyframe, is_checked, features, good_prob, worth_checking);
}

void transfer(StateArchive& archive, SubmapFeatures& features) {
  auto& [entropy, tf_idf, landmarks] = features;
  archive(entropy, tf_idf, landmarks);
}

void transfer(StateArchive& archive, LoopClosureRecord& record) {
  auto& [source, query_keyframe, match_keyframe, is_accepted, reason, score, place, inliers, T_match_query, cov,
         pairs] = record;
  auto& [histogram_divergence, descriptor_score, topology_score, scene_score, loop_prob] = place;
  archive(source, query_keyframe, match_keyframe, is_accepted, reason, score, inliers, T_match_query);
  archive(histogram_divergence, descriptor_score, topology_score, scene_score, loop_prob);
  if (is_accepted) archive(cov, pairs);
}

void BackEnd::transferKeyframes(StateArchive& archive, const SubmapArchive& submaps) {
  archive(map_.keyframes, map_.T_map_keyframe, keyframe_of_place_, checks_);
  archive(closures_, closure_of_loop_, closed_at_m_, T_map_odom_start_, merged_ids_, keyframes_of_);
  const std::size_t count = map_.keyframes.size();
  if (map_.T_map_keyframe.size() != count) StateArchive::fail("a keyframe without a pose");
  for (const int keyframe : keyframe_of_place_) requireIndex(keyframe, count);
  if (checks_.size() != submaps.submaps().size()) StateArchive::fail("a submap without keyframes");
  for (const SubmapCheck& check : checks_) requireIndex(check.first_keyframe, count);
  if (archive.isReading()) {
    for (const auto& submap : submaps.submaps()) evaluator_.add(*submap);  // counts the rarity of classes again
  }
  for (const int closure : closure_of_loop_) requireIndex(closure, closures_.size());
  for (const LoopClosureRecord& closure : closures_) {
    requireIndex(closure.query_keyframe, count);
    requireIndex(closure.match_keyframe, count);
  }
  double floor_m = config_.keyframe.sighting_floor_m;
  archive(floor_m);
  for (std::size_t k = 0; k < count; ++k) {
    MapKeyframe& keyframe = map_.keyframes[k];
    const int submap = submapOf(static_cast<int>(k));
    requireIndex(submap, submaps.submaps().size());
    SceneOfSubmap(*submaps.submaps()[static_cast<std::size_t>(submap)], keyframe.T_odom_base, floor_m)
        .transfer(archive, keyframe.scene.objects);
    for (const SceneObject& object : keyframe.scene.objects) {
      requireIndex(object.class_index, static_cast<std::size_t>(classes_.size()));
    }
  }
}

int BackEnd::submapOf(int keyframe) const {
  const auto next = std::upper_bound(checks_.begin(), checks_.end(), keyframe,
                                     [](int k, const SubmapCheck& check) { return k < check.first_keyframe; });
  return static_cast<int>(next - checks_.begin()) - 1;
}

void BackEnd::transferGraph(StateArchive& archive, const SubmapArchive& submaps) {
  archive(graph_);
  if (graph_.submaps() != static_cast<int>(map_.keyframes.size())) StateArchive::fail("a graph of other keyframes");
  std::vector<PlacesOfSubmap> places;
  if (archive.isReading()) {
    for (const auto& submap : submaps.submaps()) {
      places.push_back({classHistogram(submap->landmarks, classes_.size()), {}});
    }
    for (const int k : keyframe_of_place_) {
      const MapKeyframe& keyframe = map_.keyframes[static_cast<std::size_t>(k)];
      const int submap = submapOf(k);
      places[static_cast<std::size_t>(submap)].keyframes.push_back(
          {keyframe.frame, submap, keyframe.driven_m, keyframe.scene});
    }
  }
  places_.transfer(archive, std::move(places));
}

}  // namespace semantic_mht_slam
