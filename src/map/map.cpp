#include "semantic_mht_slam/map/map.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>
#include <utility>

namespace semantic_mht_slam {

IdRange<KeyframeId> Map::add(std::shared_ptr<const Submap> submap, std::vector<Keyframe> keyframes) {
  if (keyframes.empty()) throw std::invalid_argument("Map: a submap without keyframes");
  if (submap->id != submaps_.nextId()) throw std::invalid_argument("Map: submaps must come in their order");
  const KeyframeId first = keyframes_.nextId();
  first_keyframe_.push_back(first);
  for (Keyframe& keyframe : keyframes) {
    keyframe.submap = submap->id;
    keyframes_.push_back(std::move(keyframe));
  }
  identity_.add(*submap);
  noteLandmarks(submaps_.push_back(std::move(submap)));
  return keyframes_.idsFrom(first);
}

ClosureId Map::add(LoopClosureRecord closure) {
  closure.is_accepted = false;  // until it is decided
  closure.came_after = submaps_.back()->id;
  const ClosureId id = closures_.push_back(std::move(closure));
  if (closures_[id].is_verified) identity_.add(id, closures_[id].pairs);
  return id;
}

void Map::addPairs(ClosureId closure, const std::vector<SameLandmark>& pairs) {
  std::vector<SameLandmark>& all = closures_[closure].pairs;
  all.insert(all.end(), pairs.begin(), pairs.end());
  identity_.add(closure, pairs);
  placeAgain(identity_.changedNames());
}

void Map::apply(const GraphUpdate& update) {
  if (!update.T_map_keyframe.empty()) {
    T_map_keyframe_ = IdVector<KeyframeId, Pose>(update.T_map_keyframe);
  }
  for (const ClosureDecision& decision : update.decisions) {
    LoopClosureRecord& closure = closures_[decision.closure];
    closure.is_accepted = decision.holds;
    closure.reason = decision.holds ? "" : decision.reason;
  }
  identity_.decide(update.decisions);
  placeAgain(identity_.changedNames());
}

IdRange<KeyframeId> Map::keyframesOf(SubmapId submap) const {
  SubmapId next = submap;
  ++next;
  return {first_keyframe_[submap], first_keyframe_.has(next) ? first_keyframe_[next] : keyframes_.nextId()};
}

double Map::closedAt_m() const {
  double closed_at_m = 0.0;
  for (const LoopClosureRecord& closure : closures_) {
    if (closure.is_accepted) closed_at_m = std::max(closed_at_m, keyframes_[closure.query_keyframe].driven_m);
  }
  return closed_at_m;
}

/// Takes the landmarks of the newest submap in.
void Map::noteLandmarks(SubmapId submap) {
  double reach_m = 0.0;
  std::set<LandmarkId> names(identity_.changedNames());
  for (const MixtureLandmark& landmark : submaps_[submap]->landmarks) {
    reach_m = std::max(reach_m, landmark.position.mean_m.norm());
    newest_submap_[landmark.id] = submap;
    if (landmark.size.detections > 0) sizes_[landmark.id].add(landmark.size);
    names.insert(landmark.id);
  }
  reach_m_.push_back(reach_m);
  last_seen_in_.push_back({});
  placeAgain(names);
}

/// Finds again where the landmarks of these names were seen last; all names of each that was split or merged are there.
void Map::placeAgain(const std::set<LandmarkId>& names) {
  std::set<LandmarkId> landmarks;
  for (const LandmarkId name : names) {
    landmarks.insert(identity_.landmarkOf(name));
    const auto known = last_seen_.find(name);
    if (known == last_seen_.end()) continue;
    last_seen_in_[known->second.submap].erase(name);
    last_seen_.erase(known);
  }
  for (const LandmarkId landmark : landmarks) place(landmark);
}

void Map::place(LandmarkId landmark) {
  LastSeen seen;
  for (const LandmarkId name : identity_.namesOf(landmark)) {
    const auto newest = newest_submap_.find(name);
    if (newest == newest_submap_.end()) continue;
    if (seen.submap.isNone() || newest->second > seen.submap) seen = {newest->second, name};
  }
  const auto known = last_seen_.find(landmark);
  if (known != last_seen_.end()) last_seen_in_[known->second.submap].erase(landmark);
  if (seen.submap.isNone()) return;
  last_seen_[landmark] = seen;
  last_seen_in_[seen.submap].insert(landmark);
}

const MixtureLandmark* Map::newest(LandmarkId name) const {
  const auto submap = newest_submap_.find(name);
  return submap == newest_submap_.end() ? nullptr : findLandmark(name, submaps_[submap->second]->landmarks);
}

MixtureLandmark Map::landmark(LandmarkId id, const LastSeen& seen) const {
  MixtureLandmark result = *newest(seen.name);
  result.id = id;
  result.size = {};
  result.merged_ids = identity_.namesOf(id);
  result.existence_prob = existenceOf(id);
  for (const LandmarkId name : result.merged_ids) {
    const auto size = sizes_.find(name);
    if (size != sizes_.end()) result.size.add(size->second);
    const MixtureLandmark* other = newest(name);
    if (other == nullptr || name == seen.name) continue;
    result.observations += other->observations;
    result.seen_standing_s = std::max(result.seen_standing_s, other->seen_standing_s);
    result.first_submap = std::min(result.first_submap, other->first_submap);
  }
  if (const LockedLandmark* lock = corrections_.lockOf(result.merged_ids)) applyLock(*lock, seen.submap, result);
  result.merged_ids.erase(result.merged_ids.begin());
  return result;
}

/// The likeliest of its names counts.
double Map::existenceOf(LandmarkId landmark) const {
  double existence_prob = 0.0;
  for (const LandmarkId name : identity_.namesOf(landmark)) {
    const MixtureLandmark* known = newest(name);
    if (known != nullptr) existence_prob = std::max(existence_prob, known->existence_prob);
  }
  return existence_prob;
}

bool Map::isKept(LandmarkId landmark) const {
  const std::vector<LandmarkId> names = identity_.namesOf(landmark);
  if (!corrections_.locked().empty() && corrections_.lockOf(names) != nullptr) return true;
  if (!isLikely(landmark)) return false;
  if (corrections_.removed().empty()) return true;
  const auto seen = last_seen_.find(landmark);
  if (seen == last_seen_.end()) return !corrections_.isRemoved(names);
  const MixtureLandmark& known = *newest(seen->second.name);
  return !isRemoved(names, known.mostLikelyClass(), T_map_submap(seen->second.submap) * known.position.mean_m);
}

bool Map::hasLandmark(LandmarkId name) const {
  const LandmarkId id = identity_.landmarkOf(name);
  return last_seen_.count(id) > 0 && (isLikely(id) || corrections_.lockOf(identity_.namesOf(id)) != nullptr);
}

void Map::forEachLandmark(const Visit& visit) const {
  for (const auto& [id, seen] : last_seen_) {
    if (isKept(id)) visit(seen.submap, landmark(id, seen));
  }
}

void Map::forEachLandmarkOf(SubmapId submap,
                            const std::function<void(LandmarkId name, const MixtureLandmark& landmark)>& visit) const {
  for (const LandmarkId id : last_seen_in_[submap]) {
    const LastSeen& seen = last_seen_.at(id);
    if (hasLandmark(id)) visit(seen.name, landmark(id, seen));
  }
}

std::vector<DetectionAssociation> Map::associations() const {
  struct Known {
    LandmarkId landmark;
    double existence_prob;
    bool is_kept;
  };
  std::unordered_map<LandmarkId, Known> known_by;  // name
  const auto known = [&](LandmarkId name) -> const Known& {
    const auto [entry, is_new] = known_by.try_emplace(name);
    if (is_new) {
      const LandmarkId landmark = identity_.landmarkOf(name);
      entry->second = {landmark, existenceOf(landmark), isKept(landmark)};
    }
    return entry->second;
  };
  std::vector<DetectionAssociation> result;
  for (const auto& submap : submaps_) {
    for (DetectionAssociation association : submap->associations) {
      if (association.landmark != kNoLandmark) {
        const auto& [landmark, existence_prob, is_kept] = known(association.landmark);
        association.probability *= existence_prob;
        if (!is_kept) association.probability = 1.0 - association.probability;
        association.landmark = is_kept ? landmark : kNoLandmark;
      }
      result.push_back(association);
    }
  }
  return result;
}

}  // namespace semantic_mht_slam
