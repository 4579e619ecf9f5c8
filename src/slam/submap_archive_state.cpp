#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/map/map_state.h"
#include "semantic_mht_slam/slam/submap_archive.h"

// The state of the finished part of the map. What follows from something else that is written is not written again.
namespace semantic_mht_slam {
namespace {

std::string bytesOf(const MixtureLandmark& landmark) {
  StateArchive archive;
  MixtureLandmark copy = landmark;
  archive(copy);
  return archive.written();
}

}  // namespace

/// Most landmarks are what the newest submap says of them.
void SubmapArchive::transferLandmarks(StateArchive& archive) {
  const std::size_t count = archive.count(submap_of_.size());
  auto next = submap_of_.begin();
  LandmarkId previous = 0;
  for (std::size_t i = 0; i < count; ++i) {
    LandmarkId step = archive.isReading() ? 0 : next->first - previous;
    int submap = archive.isReading() ? 0 : (next++)->second;
    archive(step, submap);
    const LandmarkId id = previous += step;
    if (submap < 0 || submap >= static_cast<int>(submaps_.size())) {
      StateArchive::fail("a landmark of a submap that is not there");
    }
    MixtureLandmark landmark;
    if (!archive.isReading()) landmark = *find(id);
    const MixtureLandmark* known = findLandmark(id, submaps_[static_cast<std::size_t>(submap)]->landmarks);
    bool is_known = known != nullptr && bytesOf(*known) == bytesOf(landmark);
    archive(is_known);
    if (!is_known) {
      archive(landmark);
    } else if (archive.isReading()) {
      if (known == nullptr) StateArchive::fail("a landmark that its submap lacks");
      landmark = *known;
    }
    if (!archive.isReading()) continue;
    landmark.id = id;
    place(submap, std::move(landmark));
  }
}

void SubmapArchive::transfer(StateArchive& archive) {
  std::vector<Submap> submaps;
  for (const auto& submap : submaps_) submaps.push_back(*submap);
  archive(submaps);
  if (archive.isReading()) {
    submaps_.clear();
    submap_of_.clear();
    for (Submap& submap : submaps) submaps_.push_back(std::make_shared<const Submap>(std::move(submap)));
    lasting_.assign(submaps_.size(), {});
  }
  transferLandmarks(archive);
  archive(merged_ids_);
}

}  // namespace semantic_mht_slam
