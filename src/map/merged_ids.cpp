#include "semantic_mht_slam/map/merged_ids.h"

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {

LandmarkId MergedIds::resolve(LandmarkId id) const {
  for (auto it = survivor_of_.find(id); it != survivor_of_.end(); it = survivor_of_.find(id)) id = it->second;
  return id;
}

bool MergedIds::merge(LandmarkId merged, LandmarkId survivor) {
  merged = resolve(merged);
  survivor = resolve(survivor);
  if (merged == survivor) return false;
  survivor_of_[merged] = survivor;
  return true;
}

void MergedIds::transfer(StateArchive& archive) {
  archive(survivor_of_);
  for (const auto& [merged, survivor] : survivor_of_) {  // a circle would never be resolved
    LandmarkId id = survivor;
    for (std::size_t steps = 0; survivor_of_.count(id) > 0; id = survivor_of_.at(id)) {
      if (++steps > survivor_of_.size()) StateArchive::fail("landmarks that were merged in a circle");
    }
  }
}

}  // namespace semantic_mht_slam
