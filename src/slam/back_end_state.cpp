#include <algorithm>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/map_state.h"
#include "semantic_mht_slam/slam/back_end.h"

namespace semantic_mht_slam {
namespace {

void requireIndex(int index, std::size_t size) {
  if (index < 0 || index >= static_cast<int>(size)) StateArchive::fail("a number names no keyframe or closure");
}

}  // namespace

void transfer(StateArchive& archive, SceneObject& object) {
  auto& [position_m, cov_m2, class_index, landmark] = object;
  archive(position_m, cov_m2, class_index, landmark);
}

/// Without the sightings, which are in the pose graph.
void transfer(StateArchive& archive, MapKeyframe& keyframe) {
  archive(keyframe.frame, keyframe.stamp, keyframe.driven_m, keyframe.T_odom_base, keyframe.scene.objects);
}

void transfer(StateArchive& archive, LoopClosureRecord& record) {
  auto& [source, query_keyframe, match_keyframe, is_accepted, reason, score, inliers, T_match_query, cov, pairs] = record;
  archive(source, query_keyframe, match_keyframe, is_accepted, reason, score, inliers, T_match_query);
  if (is_accepted) archive(cov, pairs);
}

void BackEnd::transferKeyframes(StateArchive& archive) {
  archive(map_.keyframes, map_.T_map_keyframe, keyframe_of_place_, first_keyframe_of_submap_);
  archive(closures_, closure_of_loop_, closed_at_m_, survivor_of_, keyframes_of_);
  const std::size_t count = map_.keyframes.size();
  if (map_.T_map_keyframe.size() != count) StateArchive::fail("a keyframe without a pose");
  for (const int keyframe : keyframe_of_place_) requireIndex(keyframe, count);
  for (const int keyframe : first_keyframe_of_submap_) requireIndex(keyframe, count);
  for (const int closure : closure_of_loop_) requireIndex(closure, closures_.size());
  for (const LoopClosureRecord& closure : closures_) {
    requireIndex(closure.query_keyframe, count);
    requireIndex(closure.match_keyframe, count);
  }
  for (const MapKeyframe& keyframe : map_.keyframes) {
    for (const SceneObject& object : keyframe.scene.objects) {
      requireIndex(object.class_index, static_cast<std::size_t>(classes_.size()));
    }
  }
}

int BackEnd::submapOf(int keyframe) const {
  const auto next =
      std::upper_bound(first_keyframe_of_submap_.begin(), first_keyframe_of_submap_.end(), keyframe);
  return static_cast<int>(next - first_keyframe_of_submap_.begin()) - 1;
}

void BackEnd::transferGraph(StateArchive& archive) {
  archive(graph_);
  if (graph_.submaps() != static_cast<int>(map_.keyframes.size())) StateArchive::fail("a graph of other keyframes");
  std::vector<Keyframe> places;
  if (archive.isReading()) {
    for (const int k : keyframe_of_place_) {
      const MapKeyframe& keyframe = map_.keyframes[static_cast<std::size_t>(k)];
      places.push_back({keyframe.frame, submapOf(k), keyframe.driven_m, keyframe.scene});
    }
  }
  places_.transfer(archive, std::move(places));
}

}  // namespace semantic_mht_slam
