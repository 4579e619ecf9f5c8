#include <algorithm>

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

const MixtureLandmark* SubmapArchive::findLandmark(const Submap& submap, LandmarkId id) {
  const auto found = std::lower_bound(submap.landmarks.begin(), submap.landmarks.end(), id,
                                      [](const MixtureLandmark& landmark, LandmarkId i) { return landmark.id < i; });
  return found == submap.landmarks.end() || found->id != id ? nullptr : &*found;
}

/// Most entries are what the newest submap says of the landmark.
void SubmapArchive::transferEntries(StateArchive& archive) {
  const std::size_t count = archive.count(landmarks_.size());
  auto next = landmarks_.begin();
  LandmarkId previous = 0;
  for (std::size_t i = 0; i < count; ++i) {
    LandmarkId step = archive.isReading() ? 0 : next->first - previous;
    archive(step);
    const LandmarkId id = previous += step;
    Entry& entry = archive.isReading() ? landmarks_[id] : (next++)->second;
    archive(entry.submap);
    if (entry.submap < 0 || entry.submap >= static_cast<int>(submaps_.size())) {
      StateArchive::fail("a landmark of a submap that is not there");
    }
    const MixtureLandmark* known = findLandmark(*submaps_[static_cast<std::size_t>(entry.submap)], id);
    bool is_known = known != nullptr && bytesOf(*known) == bytesOf(entry.landmark);
    archive(is_known);
    if (!is_known) {
      archive(entry.landmark);
    } else if (archive.isReading()) {
      if (known == nullptr) StateArchive::fail("a landmark that its submap lacks");
      entry.landmark = *known;
    }
  }
}

void SubmapArchive::transfer(StateArchive& archive) {
  std::vector<Submap> submaps;
  for (const auto& submap : submaps_) submaps.push_back(*submap);
  archive(submaps);
  if (archive.isReading()) {
    submaps_.clear();
    for (Submap& submap : submaps) submaps_.push_back(std::make_shared<const Submap>(std::move(submap)));
  }
  transferEntries(archive);
  archive(merged_ids_);
}

}  // namespace semantic_mht_slam
