#include <algorithm>

#include "semantic_mht_slam/map/map.h"

// What a person says of the map's landmarks, and what follows from it.
namespace semantic_mht_slam {
namespace {

std::vector<LandmarkId> allNames(const MixtureLandmark& landmark) {
  std::vector<LandmarkId> names{landmark.id};
  names.insert(names.end(), landmark.merged_ids.begin(), landmark.merged_ids.end());
  return names;
}

}  // namespace

std::optional<std::pair<SubmapId, MixtureLandmark>> Map::find(LandmarkId name) const {
  const LandmarkId id = identity_.landmarkOf(name);
  const auto seen = last_seen_.find(id);
  if (seen == last_seen_.end() || !isKept(id)) return std::nullopt;
  return std::make_pair(seen->second.submap, landmark(id, seen->second));
}

void Map::removeLandmark(LandmarkId landmark, const Eigen::Vector3d& position_m, double radius_m) {
  const LastSeen& seen = last_seen_.at(landmark);
  RemovedLandmark removed;
  removed.names = identity_.namesOf(landmark);
  removed.newest_name = newestName();
  removed.submap = seen.submap;
  removed.position_m = T_map_submap(seen.submap).inverse() * position_m;
  removed.class_index = newest(seen.name)->mostLikelyClass();
  removed.radius_m = radius_m;
  corrections_.remove(std::move(removed));
}

bool Map::bringBackLandmark(LandmarkId name) {
  return corrections_.bringBack(identity_.namesOf(identity_.landmarkOf(name)));
}

void Map::lockLandmark(const MixtureLandmark& landmark) {
  const LastSeen& seen = last_seen_.at(landmark.id);
  LockedLandmark locked{allNames(landmark), transformed(T_map_submap(seen.submap).inverse(), landmark)};
  locked.landmark.last_submap = seen.submap;
  locked.landmark.is_locked = true;
  corrections_.unlock(locked.names);
  corrections_.lock(std::move(locked));
}

bool Map::unlockLandmark(LandmarkId name) {
  return corrections_.unlock(identity_.namesOf(identity_.landmarkOf(name)));
}

bool Map::isRemoved(const std::vector<LandmarkId>& names, ClassIndex class_index,
                    const Eigen::Vector3d& position_m) const {
  if (corrections_.isRemoved(names)) return true;
  const auto& removed = corrections_.removed();
  return std::any_of(removed.begin(), removed.end(), [&](const RemovedLandmark& other) {
    if (names.front() <= other.newest_name || class_index != other.class_index) return false;
    const Eigen::Vector3d apart_m = position_m - T_map_submap(other.submap) * other.position_m;
    return apart_m.head<2>().norm() <= other.radius_m;
  });
}

void Map::addCorrections(const LandmarkCorrections& other) {
  for (const RemovedLandmark& removed : other.removed()) corrections_.remove(removed);
  for (const LockedLandmark& locked : other.locked()) corrections_.lock(locked);
}

/// What is locked of a landmark, in the frame of the submap that saw it last.
void Map::applyLock(const LockedLandmark& lock, SubmapId submap, MixtureLandmark& landmark) const {
  const Pose T_submap_lock = T_map_submap(submap).inverse() * T_map_submap(lock.landmark.last_submap);
  const MixtureLandmark as_locked = transformed(T_submap_lock, lock.landmark);
  landmark.position = as_locked.position;
  landmark.components = as_locked.components;
  landmark.class_probs = as_locked.class_probs;
  landmark.size = as_locked.size;
  landmark.existence_prob = 1.0;
  landmark.is_locked = true;
}

}  // namespace semantic_mht_slam
