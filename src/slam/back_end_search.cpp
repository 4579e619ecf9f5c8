#include "semantic_mht_slam/slam/back_end.h"

// Where something that was seen is in the map, without adding it.
namespace semantic_mht_slam {

std::optional<Pose> BackEnd::locate(const Scene& scene) const {
  std::vector<Pose> poses;
  for (const int k : keyframe_of_place_) poses.push_back(map_.T_map_keyframe[static_cast<std::size_t>(k)]);
  const std::vector<PlaceMatch> matches = places_.locate(scene, poses);
  if (matches.empty()) return std::nullopt;
  const PlaceMatch& best = matches.front();
  // A match that passed every check but would not be believed alone is one of two that confirm each other.
  if (!best.accepted && best.refusal != PlaceRefusal::kUnsupported) return std::nullopt;
  return poses[best.match] * best.T_match_query;
}

std::optional<Pose> BackEnd::findNear(const Scene& scene, const Pose& T_map_base, double drifted_m) const {
  const AlignmentPrior prior = driftPrior(T_map_base, drifted_m, config_.revisit);
  const LoopClosureRecord* best = nullptr;
  const std::vector<LoopClosureRecord> records = findInMap(map_, scene, prior, classes_, config_.revisit);
  for (const LoopClosureRecord& record : records) {
    if (record.is_accepted && (best == nullptr || record.score > best->score)) best = &record;
  }
  if (best == nullptr) return std::nullopt;
  return map_.T_map_keyframe[static_cast<std::size_t>(best->match_keyframe)] * best->T_match_query;
}

}  // namespace semantic_mht_slam
