#include "semantic_mht_slam/merging/joined_map.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

namespace semantic_mht_slam {
namespace {

constexpr double kBetweenMaps_m = 1000.0;  // driven, for whoever takes what was driven lately for one pass
constexpr double kUnknown_m = 1000.0;      // deviation of the way from the end of a map to the beginning of the next
constexpr double kUnknown_rad = 1.0;

/// Numbers of one map in the joined one.
class Renaming {
 public:
  Renaming(const JoinedMember& member, std::size_t frames) : member_(member), frames_(frames) {}

  LandmarkId operator()(LandmarkId id) const { return id == kNoLandmark ? id : id + member_.landmark_offset; }
  KeyframeId operator()(KeyframeId id) const { return KeyframeId(id.index() + member_.first_keyframe); }
  SubmapId operator()(SubmapId id) const { return id.isNone() ? id : SubmapId(id.index() + member_.first_submap); }

  void apply(SameLandmark& pair) const { pair = {(*this)(pair.first), (*this)(pair.second)}; }

  void apply(MixtureLandmark& landmark) const {
    landmark.id = (*this)(landmark.id);
    landmark.first_submap = (*this)(landmark.first_submap);
    landmark.last_submap = (*this)(landmark.last_submap);
    for (LandmarkId& id : landmark.merged_ids) id = (*this)(id);
  }

  Submap operator()(Submap submap) const {
    submap.id = (*this)(submap.id);
    for (MixtureLandmark& landmark : submap.landmarks) apply(landmark);
    for (DetectionAssociation& association : submap.associations) {
      association.landmark = (*this)(association.landmark);
      association.frame += frames_;
    }
    for (SameLandmark& pair : submap.duplicates) apply(pair);
    for (NearLandmarks& near : submap.near) {
      near.a = (*this)(near.a);
      near.b = (*this)(near.b);
    }
    return submap;
  }

  LandmarkCorrections operator()(const LandmarkCorrections& corrections) const {
    LandmarkCorrections result;
    for (RemovedLandmark removed : corrections.removed()) {
      for (LandmarkId& name : removed.names) name = (*this)(name);
      removed.newest_name = (*this)(removed.newest_name);
      removed.submap = (*this)(removed.submap);
      result.remove(std::move(removed));
    }
    for (LockedLandmark locked : corrections.locked()) {
      for (LandmarkId& name : locked.names) name = (*this)(name);
      apply(locked.landmark);
      result.lock(std::move(locked));
    }
    return result;
  }

  Keyframe operator()(Keyframe keyframe, const Motion& before) const {
    keyframe.frame += frames_;
    keyframe.submap = (*this)(keyframe.submap);
    keyframe.driven_m += before.way_m;
    keyframe.turned_rad += before.turn_rad;
    for (SceneObject& object : keyframe.scene.objects) object.landmark = (*this)(object.landmark);
    return keyframe;
  }

 private:
  const JoinedMember& member_;
  std::size_t frames_;
};

std::size_t framesOf(const Map& map) {
  std::size_t frames = 0;
  for (const Keyframe& keyframe : map.keyframes()) frames = std::max(frames, keyframe.frame + 1);
  for (const auto& submap : map.submaps()) {
    for (const auto& association : submap->associations) frames = std::max(frames, association.frame + 1);
  }
  return frames;
}

LandmarkId newestLandmark(const Map& map) {
  LandmarkId newest = kNoLandmark;
  for (const auto& submap : map.submaps()) {
    for (const MixtureLandmark& landmark : submap->landmarks) {
      newest = std::max(newest, landmark.id);
      for (const LandmarkId id : landmark.merged_ids) newest = std::max(newest, id);
    }
    for (const DetectionAssociation& association : submap->associations) {
      newest = std::max(newest, association.landmark);
    }
    for (const auto& [second, first] : submap->duplicates) newest = std::max({newest, first, second});
  }
  return newest;
}

/// Puts the maps one behind the other.
class Joining {
 public:
  Joining(std::vector<JoinedMember> members, const MergeSettings& settings)
      : settings_(settings), result_{makeParts(settings.slam, settings.classes), std::move(members)} {
    SlamParts& parts = result_.parts;
    parts.range_factor = settings.range_factor;
    fitParts(settings.slam, settings.classes, parts);
  }

  JoinedMap run(std::vector<CrossClosure> closures) {
    for (std::size_t m = 0; m < result_.members.size(); ++m) {
      std::vector<CrossClosure> of_member;
      for (CrossClosure& closure : closures) {
        if (closure.query_map == m) of_member.push_back(std::move(closure));
      }
      append(result_.members[m], std::move(of_member));
    }
    solve();
    appendSessions();
    finish();
    return std::move(result_);
  }

 private:
  void append(JoinedMember& member, std::vector<CrossClosure> cross) {
    const Map& map = member.map->map();
    Map& joined = result_.parts.map;
    member.first_keyframe = joined.keyframes().size();
    member.first_submap = joined.submaps().size();
    member.landmark_offset = landmarks_;
    const Renaming rename(member, frames_);
    std::vector<LoopClosureRecord> closures = closuresOf(member, rename, std::move(cross));
    auto closure = closures.begin();
    for (const SubmapId id : map.submaps().ids()) {
      std::vector<Keyframe> keyframes;
      for (const KeyframeId k : map.keyframesOf(id)) keyframes.push_back(rename(map.keyframes()[k], driven_));
      joined.add(std::make_shared<const Submap>(rename(*map.submaps()[id])), std::move(keyframes));
      for (const KeyframeId k : map.keyframesOf(id)) addNode(member, rename, k);
      // In the order in which a map that is read takes them.
      for (; closure != closures.end() && joined.keyframes().has(closure->query_keyframe); ++closure) {
        joined.add(std::move(*closure));
      }
    }
    joined.addCorrections(rename(map.corrections()));
    frames_ += framesOf(map);
    landmarks_ += newestLandmark(map);
    driven_ = motionTo(joined.keyframes().back());
    driven_.way_m += kBetweenMaps_m;
  }

  /// By rising query. What the map's own graph refused stays refused.
  std::vector<LoopClosureRecord> closuresOf(const JoinedMember& member, const Renaming& rename,
                                            std::vector<CrossClosure> cross) const {
    std::vector<LoopClosureRecord> closures;
    for (LoopClosureRecord closure : member.map->map().closures()) {
      closure.is_verified = closure.is_accepted;
      closure.match_keyframe = rename(closure.match_keyframe);
      closure.query_keyframe = rename(closure.query_keyframe);
      for (SameLandmark& pair : closure.pairs) rename.apply(pair);
      closures.push_back(std::move(closure));
    }
    for (CrossClosure& closure : cross) {
      const JoinedMember& match = result_.members[closure.match_map];
      const Renaming rename_match(match, 0);
      LoopClosureRecord& record = closure.record;
      record.query_keyframe = rename(record.query_keyframe);
      record.match_keyframe = rename_match(record.match_keyframe);
      for (SameLandmark& pair : record.pairs) pair = {rename(pair.first), rename_match(pair.second)};
      closures.push_back(std::move(record));
    }
    std::stable_sort(closures.begin(), closures.end(), [](const LoopClosureRecord& a, const LoopClosureRecord& b) {
      return a.query_keyframe < b.query_keyframe;
    });
    return closures;
  }

  void addNode(const JoinedMember& member, const Renaming& rename, KeyframeId keyframe) {
    PoseNode node = member.map->parts().graph.node(keyframe);
    node.T_world_node = member.T_joined_map * member.map->map().T_map_keyframe(keyframe);
    if (keyframe == KeyframeId(0)) {
      node.T_previous_node = T_joined_newest_.inverse() * *node.T_world_node;
      node.odometry_cov.setZero();
      node.odometry_cov.diagonal().head<3>().setConstant(kUnknown_m * kUnknown_m);
      node.odometry_cov.diagonal().tail<3>().setConstant(kUnknown_rad * kUnknown_rad);
    }
    T_joined_newest_ = *node.T_world_node;
    for (LandmarkSighting& sighting : node.sightings) {
      sighting.landmark = static_cast<std::int64_t>(rename(static_cast<LandmarkId>(sighting.landmark)));
    }
    result_.parts.graph.add(node);
  }

  void solve() {
    Map& map = result_.parts.map;
    result_.parts.graph.settle(map, true);
    for (const SubmapId id : map.submaps().ids()) result_.parts.closer->takeIn(map, id);
  }

  /// Odometry of all maps, one session behind the other; what was only localized moves with the keyframe next to it.
  void appendSessions() {
    const Map& joined = result_.parts.map;
    for (const JoinedMember& member : result_.members) {
      const Map& map = member.map->map();
      const auto T_joined = [&](const Pose& T_map_base) {
        const KeyframeId near = member.map->nearestKeyframe(T_map_base.translation_m);
        const Pose& T_joined_near = joined.T_map_keyframe(KeyframeId(near.index() + member.first_keyframe));
        return T_joined_near * map.T_map_keyframe(near).inverse() * T_map_base;
      };
      result_.parts.sessions.append(member.map->parts().sessions, KeyframeId(member.first_keyframe), T_joined);
    }
  }

  /// What a session needs that begins in this map: all that the first map's detector and odometry taught.
  void finish() {
    SlamParts& parts = result_.parts;
    const SlamParts& first = result_.members.front().map->parts();
    if (first.mapper) {
      StateArchive writing;
      const_cast<Mapper&>(*first.mapper).transfer(writing);  // a writing archive changes nothing
      const std::string reading_bytes = writing.written();
      StateArchive reading(reading_bytes);
      parts.mapper->transfer(reading);
    }
    parts.mapper->goOnAfter(SubmapId(parts.map.submaps().size() - 1), landmarks_);
    parts.mapper->forgetSurroundings();
    parts.odometry = parts.mapper->odometryModel();
    parts.closer->setOdometry(parts.odometry);
    parts.is_fitted = true;
    parts.detector_range = first.detector_range;
    parts.assembler.countFrom(frames_);
    parts.driven = driven_;
    parts.tied_at_m = driven_.way_m;
    parts.sessions.begin(parts.map.keyframes().nextId());
    Localizer localizer(settings_.slam.localization);
    parts.mode = Localizing{std::move(localizer), true};
  }

  const MergeSettings& settings_;
  JoinedMap result_;
  std::size_t frames_ = 0;
  LandmarkId landmarks_ = 0;
  Motion driven_;
  Pose T_joined_newest_;
};

}  // namespace

JoinedMap joinMaps(std::vector<JoinedMember> members, std::vector<CrossClosure> closures,
                   const MergeSettings& settings) {
  return Joining(std::move(members), settings).run(std::move(closures));
}

}  // namespace semantic_mht_slam
