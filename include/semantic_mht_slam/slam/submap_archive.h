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

  /// The ids that were merged into each landmark that took others in.
  std::map<LandmarkId, std::vector<LandmarkId>> mergedInto() const;

  /// A landmark of a submap as the submap has it, by the id that it had then; null if the submap lacks it.
  static const MixtureLandmark* findLandmark(const Submap& submap, LandmarkId id);

  /// The landmark that an id stands for now: itself, or the one that it was merged into.
  LandmarkId resolve(LandmarkId id) const { return merged_ids_.resolve(id); }

  /// Every detection of the finished submaps with the landmark of the map that it belongs to; kNoLandmark for false
  /// positives and for landmarks that did not make it into the map.
  std::vector<DetectionAssociation> associations() const;

  /// All submaps and landmarks (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  struct Entry {
    int submap = 0;  ///< index in `submaps_`
    MixtureLandmark landmark;
  };

  void transferEntries(StateArchive& archive);

  bool isKept(const Entry& entry) const { return entry.landmark.existence_prob >= keep_prob_; }
  bool isKept(LandmarkId id) const;

  double keep_prob_;
  std::vector<std::shared_ptr<const Submap>> submaps_;
  std::map<LandmarkId, Entry> landmarks_;
  MergedIds merged_ids_;
};

/// A landmark moved from frame b to frame a.
MixtureLandmark transformed(const Pose& T_a_b, const MixtureLandmark& landmark);

}  // namespace semantic_mht_slam
