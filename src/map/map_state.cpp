#include "semantic_mht_slam/map/map_state.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/map/map.h"

// The state of the finished part of the map. What follows from something else that is written is not written again.
namespace semantic_mht_slam {
namespace {

constexpr int kMostSized = 1 << 24;  // whose sums over submaps are numbers

bool areEqual(const Gaussian3& a, const Gaussian3& b) {
  return a.mean_m == b.mean_m && a.cov_m2 == b.cov_m2;
}

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
    const std::size_t count = archive.count<SceneObject>(objects.size());
    if (archive.isReading()) objects.clear();
    makeRoom(objects, count);
    LandmarkId last = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (archive.isReading()) objects.emplace_back();
      SceneObject& object = objects[i];
      const std::optional<SceneObject> known = archive.isReading() ? std::nullopt : find(object.landmark);
      bool is_known = known && areEqual(*known, object);
      LandmarkId step = object.landmark - last;
      archive(is_known, step);
      object.landmark = last += step;
      archive.requireName(object.landmark);
      if (!is_known) {
        Gaussian3 place{object.position_m, object.cov_m2};
        archive(place, object.class_index);
        object.position_m = place.mean_m;
        object.cov_m2 = place.cov_m2;
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

/// Names of two landmarks that are one.
void requirePairs(const StateArchive& archive, const std::vector<SameLandmark>& pairs) {
  for (const auto& [a, b] : pairs) {
    archive.requireName(a);
    archive.requireName(b);
  }
}

template <class IdType, class Value>
void require(IdType id, const IdVector<IdType, Value>& list) {
  if (!list.has(id)) StateArchive::fail("a number names no submap, keyframe or closure");
}

}  // namespace

void transfer(StateArchive& archive, MixtureComponent& component) {
  auto& [weight, position] = component;
  archive(weight, position);
  archive.require(weight > 0.0 && isProbability(weight), "a component without weight");
}

void transfer(StateArchive& archive, MixtureLandmark& landmark) {
  auto& [id, components, position, class_probs, existence_prob, seen_standing_s, observations, first_submap,
         last_submap, merged_ids, size, is_locked] = landmark;
  archive(id, components);
  // A landmark that nobody disputes has one component, which is all that is known of its place.
  bool is_as_component = components.size() == 1 && areEqual(components.front().position, position);
  archive(is_as_component);
  if (!is_as_component) archive(position);
  if (is_as_component && archive.isReading()) {
    if (components.empty()) StateArchive::fail("a landmark without a place");
    position = components.front().position;
  }
  archive(class_probs, existence_prob, seen_standing_s, observations, first_submap, last_submap, merged_ids, is_locked);
  archive(size.detections);
  if (size.detections > 0) archive(size.mean_m);
  archive.require(size.detections >= 0 && size.detections <= kMostSized && (size.mean_m.array() >= 0.0).all(),
                  "a landmark of a negative size");
  archive.requireName(id);
  archive.requireClassCount(class_probs.size());
  archive.require(!components.empty(), "a landmark without a place");
  archive.require(areProbabilities(class_probs) && isProbability(existence_prob), "probabilities that are none");
  archive.require(observations >= 0 && seen_standing_s >= 0.0 && !first_submap.isNone() && first_submap <= last_submap,
                  "a landmark that was seen before it was seen first");
}

void transferAssociations(StateArchive& archive, std::vector<DetectionAssociation>& associations) {
  const std::size_t count = archive.count<DetectionAssociation>(associations.size());
  if (archive.isReading()) associations.clear();
  makeRoom(associations, count);
  DetectionAssociation last;
  for (std::size_t i = 0; i < count; ++i) {
    if (archive.isReading()) associations.emplace_back();
    auto& [frame, row, landmark, probability] = associations[i];
    // Differences are small numbers, and alike from frame to frame; both are unsigned to wrap around.
    std::size_t frame_step = frame - last.frame;
    auto row_step = static_cast<std::int64_t>(row) - (frame_step == 0 ? last.row : 0);
    std::uint64_t landmark_step = landmark - last.landmark;
    auto thousandths = static_cast<int>(std::lround(1000.0 * probability));
    archive(frame_step, row_step, landmark_step, thousandths);
    archive.require(thousandths >= 0 && thousandths <= 1000, "probabilities that are none");
    probability = 0.001 * thousandths;
    frame = last.frame + frame_step;
    const std::int64_t row_now = row_step + (frame_step == 0 ? last.row : 0);
    archive.require(row_now >= 0 && row_now <= std::numeric_limits<int>::max() && frame >= last.frame,
                    "detections that are not in order");
    row = static_cast<int>(row_now);
    landmark = last.landmark + landmark_step;
    if (landmark != kNoLandmark) archive.requireName(landmark);
    last = {frame, row, landmark == kNoLandmark ? last.landmark : landmark};
  }
}

void transfer(StateArchive& archive, NearLandmarks& near) {
  auto& [a, b, frames] = near;
  archive(a, b, frames);
  archive.requireName(a);
  archive.requireName(b);
  archive.require(a < b && frames >= 0, "near landmarks that are not in order");
}

void transfer(StateArchive& archive, Submap& submap) {
  auto& [id, begin, end, T_odom_submap, landmarks, associations, duplicates, near] = submap;
  archive(id, begin, end, T_odom_submap, landmarks);
  transferAssociations(archive, associations);
  archive(duplicates, near);
  archive.requireStamp(begin);
  archive.requireStamp(end);
  archive.require(begin <= end, "a submap that ends before it begins");
  requirePairs(archive, duplicates);
  archive.require(areRising(landmarks, [](const MixtureLandmark& landmark) { return landmark.id; }),
                  "landmarks whose ids do not rise");
  for (const MixtureLandmark& landmark : landmarks) {
    archive.require(landmark.last_submap == id, "a landmark of another submap");
  }
}

/// Without the scene.
void transfer(StateArchive& archive, Keyframe& keyframe) {
  archive(keyframe.frame, keyframe.submap, keyframe.stamp, keyframe.driven_m, keyframe.T_odom_base);
  archive(keyframe.turned_rad);
  archive.requireStamp(keyframe.stamp);
  archive.require(keyframe.driven_m >= 0.0 && keyframe.turned_rad >= 0.0, "a negative way");
}

/// Of closures that never were in the pose graph only what people look at is kept.
void transfer(StateArchive& archive, LoopClosureRecord& closure) {
  auto& [source, query_keyframe, match_keyframe, is_verified, is_accepted, reason, score, place, inliers, T_match_query,
         cov, came_after, pairs] = closure;
  auto& [histogram_divergence, descriptor_score, topology_score, scene_score, loop_prob] = place;
  archive(source, query_keyframe, match_keyframe, is_verified, is_accepted, reason, score, inliers, T_match_query);
  archive(came_after, histogram_divergence, descriptor_score, topology_score, scene_score, loop_prob);
  if (is_verified) archive(cov, pairs);
  archive.require(source >= ClosureSource::kPlace && source <= ClosureSource::kRequest, "a source that there is not");
  archive.require(inliers >= 0 && isNotNegative(cov), "a closure whose covariance is not positive");
  archive.require(is_verified || !is_accepted, "a closure that holds without a check");
  requirePairs(archive, pairs);
}

void Map::transferSubmaps(StateArchive& archive) {
  std::vector<Submap> submaps;
  for (const auto& submap : submaps_) submaps.push_back(*submap);
  archive(submaps);
  if (!archive.isReading()) return;
  for (Submap& submap : submaps) {
    if (submap.id != submaps_.nextId()) StateArchive::fail("submaps that are not in order");
    submaps_.push_back(std::make_shared<const Submap>(std::move(submap)));
  }
}

void Map::transferKeyframes(StateArchive& archive, int classes, double scene_floor_m) {
  archive(keyframes_, T_map_keyframe_, first_keyframe_, closures_, identity_, scene_floor_m, corrections_);
  if (T_map_keyframe_.size() != keyframes_.size()) StateArchive::fail("a keyframe without a pose");
  if (first_keyframe_.size() != submaps_.size()) StateArchive::fail("a submap without keyframes");
  requireKeyframesOfSubmaps(archive);
  for (Keyframe& keyframe : keyframes_) {
    require(keyframe.submap, submaps_);
    SceneOfSubmap(*submaps_[keyframe.submap], keyframe.T_odom_base, scene_floor_m)
        .transfer(archive, keyframe.scene.objects);
    for (const SceneObject& object : keyframe.scene.objects) {
      if (object.class_index < 0 || object.class_index >= classes) StateArchive::fail("an object of no known class");
    }
  }
  if (!archive.isReading()) return;
  SubmapId newest(0);
  for (const LoopClosureRecord& closure : closures_) {
    require(closure.query_keyframe, keyframes_);
    require(closure.match_keyframe, keyframes_);
    require(closure.came_after, submaps_);
    archive.require(closure.came_after >= newest && closure.query_keyframe != closure.match_keyframe &&
                        keyframes_[closure.query_keyframe].submap <= closure.came_after,
                    "closures that are not in order");
    newest = closure.came_after;
  }
  for (const IdentityEvent& event : identity_.ledger()) {
    require(event.submap, submaps_);
    if (!event.closure.isNone()) require(event.closure, closures_);
    archive.requireName(event.a);
    archive.requireName(event.b);
  }
  for (const RemovedLandmark& removed : corrections_.removed()) require(removed.submap, submaps_);
  for (const LockedLandmark& locked : corrections_.locked()) require(locked.landmark.last_submap, submaps_);
  restore();
}

/// Each submap has keyframes, the next ones in their order.
void Map::requireKeyframesOfSubmaps(const StateArchive& archive) const {
  SubmapId submap(0);
  for (const KeyframeId id : keyframes_.ids()) {
    const bool begins_next = first_keyframe_.has(submap) && first_keyframe_[submap] == id;
    if (begins_next) ++submap;
    archive.require(submap.index() > 0 && keyframes_[id].submap == SubmapId(submap.index() - 1),
                    "keyframes of other submaps");
    archive.require(id == KeyframeId(0) || keyframes_[KeyframeId(id.index() - 1)].driven_m <= keyframes_[id].driven_m,
                    "keyframes that are not in the order of the drive");
  }
  archive.require(submap == submaps_.nextId(), "a submap without keyframes");
}

LandmarkId Map::newestName() const {
  return newest_submap_.empty() ? kNoLandmark : newest_submap_.rbegin()->first;
}

/// What follows from submaps and closures.
void Map::restore() {
  std::vector<Identity::Saying> sayings;
  for (const ClosureId id : closures_.ids()) {
    const LoopClosureRecord& closure = closures_[id];
    if (!closure.is_verified) continue;
    sayings.push_back({closure.came_after, {id, closure.is_accepted}, &closure.pairs});
  }
  identity_.restore(submaps_, sayings);
  for (const SubmapId submap : submaps_.ids()) noteLandmarks(submap);
}

}  // namespace semantic_mht_slam
