#pragma once

#include <map>

#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

class StateArchive;

/// Which landmark a landmark was merged into. Every id stays resolvable, however often its survivor is merged again.
class MergedIds {
 public:
  /// The landmark that an id stands for now: itself, or what it was merged into in the end.
  LandmarkId resolve(LandmarkId id) const;

  /// Makes what `merged` stands for stand for what `survivor` stands for. False if they are one already.
  bool merge(LandmarkId merged, LandmarkId survivor);

  /// Survivor by merged id; the survivor may have been merged again.
  const std::map<LandmarkId, LandmarkId>& survivors() const { return survivor_of_; }

  void transfer(StateArchive& archive);

 private:
  std::map<LandmarkId, LandmarkId> survivor_of_;
};

}  // namespace semantic_mht_slam
