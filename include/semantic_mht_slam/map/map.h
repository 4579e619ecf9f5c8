#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/map/identity.h"
#include "semantic_mht_slam/map/ids.h"
#include "semantic_mht_slam/map/keyframe.h"
#include "semantic_mht_slam/map/landmark_corrections.h"
#include "semantic_mht_slam/map/loop_closure_record.h"
#include "semantic_mht_slam/map/submap.h"

namespace semantic_mht_slam {

class StateArchive;

/// What a solution of the pose graph says of the map.
struct GraphUpdate {
  std::vector<Pose> T_map_keyframe;        ///< of every keyframe; empty: as they were
  std::vector<ClosureDecision> decisions;  ///< of verified closures, where they differ from the last ones
  std::string failure;                     ///< empty, or why the poses are as they were
};

/// The map: finished submaps, keyframes cut from them with their poses, loop closures, landmarks, and which names mean
/// the same one. The only owner of each of these.
class Map {
 public:
  using Visit = std::function<void(SubmapId submap, const MixtureLandmark& landmark)>;

  /// Landmarks with less existence probability are kept to be seen again, but are not part of the map.
  explicit Map(double keep_prob) : keep_prob_(keep_prob) {}

  /// Takes the next submap with its keyframes, at least one, which begin where the submap begins. Their poses come with
  /// the next update.
  IdRange<KeyframeId> add(std::shared_ptr<const Submap> submap, std::vector<Keyframe> keyframes);

  /// Takes a closure that was looked at. One that is verified holds once an update says so.
  ClosureId add(LoopClosureRecord closure);

  /// More landmarks that a verified closure shows to be one, beside those that it was added with.
  void addPairs(ClosureId closure, const std::vector<SameLandmark>& pairs);

  void apply(const GraphUpdate& update);

  const IdVector<SubmapId, std::shared_ptr<const Submap>>& submaps() const { return submaps_; }
  const IdVector<KeyframeId, Keyframe>& keyframes() const { return keyframes_; }
  const IdVector<ClosureId, LoopClosureRecord>& closures() const { return closures_; }
  const Identity& identity() const { return identity_; }

  /// The landmarks with other names than at the last call (see `Identity::takeChanges`).
  std::vector<std::vector<LandmarkId>> takeChanges() { return identity_.takeChanges(); }

  const Pose& T_map_keyframe(KeyframeId keyframe) const { return T_map_keyframe_[keyframe]; }
  const IdVector<KeyframeId, Pose>& T_map_keyframes() const { return T_map_keyframe_; }

  /// A submap begins with its first keyframe.
  const Pose& T_map_submap(SubmapId submap) const { return T_map_keyframe_[first_keyframe_[submap]]; }

  IdRange<KeyframeId> keyframesOf(SubmapId submap) const;

  /// Distance driven at the newest keyframe that a closure ties to an earlier one; 0 without any.
  double closedAt_m() const;

  /// Shows the landmarks of the map by rising id, each with the submap that saw it last, as that submap has it and in
  /// its frame; counts and existence are those of all its names.
  void forEachLandmark(const Visit& visit) const;

  /// The same for the landmarks that one submap saw last, those that were removed among them: they are to be
  /// recognised; `name` is what that submap calls it.
  void forEachLandmarkOf(SubmapId submap,
                         const std::function<void(LandmarkId name, const MixtureLandmark& landmark)>& visit) const;

  /// True if a name is that of a landmark of the map, or of one that was removed from it.
  bool hasLandmark(LandmarkId name) const;

  /// The landmark that a name means, as `forEachLandmark` shows it, with the submap whose frame it is in; empty if it
  /// is no part of the map.
  std::optional<std::pair<SubmapId, MixtureLandmark>> find(LandmarkId name) const;

  /// Takes a landmark of the map out: by all its names, and by its place (map frame) for what is seen later and is not
  /// recognised as it.
  void removeLandmark(LandmarkId landmark, const Eigen::Vector3d& position_m, double radius_m);

  /// Brings a landmark back that was removed; false if that name was not.
  bool bringBackLandmark(LandmarkId name);

  /// From now on a landmark has the place (map frame), class and size that it has here, whatever is seen; it moves with
  /// the submap that saw it last.
  void lockLandmark(const MixtureLandmark& landmark);
  bool unlockLandmark(LandmarkId name);

  /// True if a landmark with these names (rising) at this place (map frame) is one that was removed.
  bool isRemoved(const std::vector<LandmarkId>& names, ClassIndex class_index, const Eigen::Vector3d& position_m) const;

  const LandmarkCorrections& corrections() const { return corrections_; }

  /// What a person said of the landmarks of another map that was put into this one, already by the names of this one.
  void addCorrections(const LandmarkCorrections& other);

  /// Least existence probability of a landmark of the map.
  double keepProb() const { return keep_prob_; }

  /// Distance from a submap's origin within which it has all its landmarks.
  double reach_m(SubmapId submap) const { return reach_m_[submap]; }

  /// Every detection of the finished submaps with the landmark of the map that it belongs to; kNoLandmark for false
  /// positives and for landmarks that did not make it into the map.
  std::vector<DetectionAssociation> associations() const;

  /// Into an empty map, or out of one (see `StateArchive`): the submaps; then the rest. Sightings are not kept.
  void transferSubmaps(StateArchive& archive);
  void transferKeyframes(StateArchive& archive, int classes, double scene_floor_m);

  /// The newest name of a landmark of the finished submaps.
  LandmarkId newestName() const;

 private:
  /// Where a landmark was seen last.
  struct LastSeen {
    SubmapId submap;
    LandmarkId name = kNoLandmark;
  };

  void noteLandmarks(SubmapId submap);
  void placeAgain(const std::set<LandmarkId>& names);
  void place(LandmarkId landmark);
  const MixtureLandmark* newest(LandmarkId name) const;
  MixtureLandmark landmark(LandmarkId id, const LastSeen& seen) const;
  void applyLock(const LockedLandmark& lock, SubmapId submap, MixtureLandmark& landmark) const;
  double existenceOf(LandmarkId landmark) const;
  bool isLikely(LandmarkId landmark) const { return existenceOf(landmark) >= keep_prob_; }
  bool isKept(LandmarkId landmark) const;
  void requireKeyframesOfSubmaps(const StateArchive& archive) const;
  void restore();

  double keep_prob_;
  IdVector<SubmapId, std::shared_ptr<const Submap>> submaps_;
  IdVector<SubmapId, KeyframeId> first_keyframe_;
  IdVector<SubmapId, double> reach_m_;
  IdVector<KeyframeId, Keyframe> keyframes_;
  IdVector<KeyframeId, Pose> T_map_keyframe_;
  IdVector<ClosureId, LoopClosureRecord> closures_;
  Identity identity_;
  LandmarkCorrections corrections_;
  std::map<LandmarkId, SubmapId> newest_submap_;           ///< with a landmark of a name
  std::map<LandmarkId, LandmarkSize> sizes_;               ///< by name
  std::map<LandmarkId, LastSeen> last_seen_;               ///< by landmark
  IdVector<SubmapId, std::set<LandmarkId>> last_seen_in_;  ///< landmarks, by submap
};

}  // namespace semantic_mht_slam
