#pragma once

#include <functional>
#include <map>
#include <memory>
#include <vector>

#include "semantic_mht_slam/map/merged_ids.h"
#include "semantic_mht_slam/map/submap.h"

namespace semantic_mht_slam {

class StateArchive;

/// The finished submaps and what they know of each landmark. Merged ids stay resolvable.
class SubmapArchive {
 public:
  /// Landmarks with less existence probability are kept to be seen again, but are not part of the map.
  explicit SubmapArchive(double keep_prob) : keep_prob_(keep_prob) {}

  void add(std::shared_ptr<const Submap> submap);

  /// Makes two landmarks one; the survivor keeps its id, both stay resolvable.
  void merge(LandmarkId merged, LandmarkId survivor);

  const std::vector<std::shared_ptr<const Submap>>& submaps() const { return submaps_; }

  /// Shows the landmarks of the map by rising id, each with the index of the submap that saw it last, as that submap
  /// has it and in its frame.
  void forEachLandmark(const std::function<void(int submap, const MixtureLandmark& landmark)>& visit) const;

  /// The same for the landmarks that one submap saw last.
  void forEachLandmarkOf(int submap, const std::function<void(const MixtureLandmark& landmark)>& visit) const;

  /// Distance from a submap's origin within which it has all landmarks that it saw last.
  double reach_m(int submap) const { return lasting_[static_cast<std::size_t>(submap)].reach_m; }

  /// The ids that were merged into each landmark that took others in.
  std::map<LandmarkId, std::vector<LandmarkId>> mergedInto() const;

  /// The landmark that an id stands for now: itself, or the one that it was merged into.
  LandmarkId resolve(LandmarkId id) const { return merged_ids_.resolve(id); }

  /// Every detection of the finished submaps with the landmark of the map that it belongs to; kNoLandmark for false
  /// positives and for landmarks that did not make it into the map.
  std::vector<DetectionAssociation> associations() const;

  /// All submaps and landmarks (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  /// What a submap is the last to have seen.
  struct Lasting {
    std::vector<MixtureLandmark> landmarks;  ///< by rising id
    double reach_m = 0.0;                    ///< does not shrink when landmarks go
  };

  void transferLandmarks(StateArchive& archive);
  const MixtureLandmark* find(LandmarkId id) const;
  MixtureLandmark* find(LandmarkId id);
  void place(int submap, MixtureLandmark landmark);
  void remove(LandmarkId id);
  bool isKept(const MixtureLandmark& landmark) const { return landmark.existence_prob >= keep_prob_; }
  bool isKept(LandmarkId id) const;

  double keep_prob_;
  std::vector<std::shared_ptr<const Submap>> submaps_;
  std::vector<Lasting> lasting_;         ///< of each submap
  std::map<LandmarkId, int> submap_of_;  ///< that saw a landmark last: index in `submaps_`
  MergedIds merged_ids_;
};

/// A landmark moved from frame b to frame a.
MixtureLandmark transformed(const Pose& T_a_b, const MixtureLandmark& landmark);

}  // namespace semantic_mht_slam
