#include "semantic_mht_slam/map/landmark_corrections.h"

#include <algorithm>

#include "semantic_mht_slam/common/state_checks.h"
#include "semantic_mht_slam/map/map_state.h"

namespace semantic_mht_slam {
namespace {

/// Both rising.
bool haveCommon(const std::vector<LandmarkId>& a, const std::vector<LandmarkId>& b) {
  for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
    if (*i == *j) return true;
    *i < *j ? ++i : ++j;
  }
  return false;
}

template <class Entry>
bool erase(const std::vector<LandmarkId>& names, std::vector<Entry>& entries) {
  const auto end = std::remove_if(entries.begin(), entries.end(),
                                  [&](const Entry& entry) { return haveCommon(entry.names, names); });
  const bool is_any = end != entries.end();
  entries.erase(end, entries.end());
  return is_any;
}

void transferNames(StateArchive& archive, std::vector<LandmarkId>& names) {
  archive(names);
  archive.require(!names.empty() && areRising(names, [](LandmarkId name) { return name; }),
                  "names of a landmark that do not rise");
  for (const LandmarkId name : names) archive.requireName(name);
}

}  // namespace

bool LandmarkCorrections::bringBack(const std::vector<LandmarkId>& names) {
  return erase(names, removed_);
}

bool LandmarkCorrections::unlock(const std::vector<LandmarkId>& names) {
  return erase(names, locked_);
}

bool LandmarkCorrections::isRemoved(const std::vector<LandmarkId>& names) const {
  const auto is_removed_name = [&](LandmarkId name) {
    return std::any_of(removed_.begin(), removed_.end(), [&](const RemovedLandmark& removed) {
      return std::binary_search(removed.names.begin(), removed.names.end(), name);
    });
  };
  return std::any_of(removed_.begin(), removed_.end(), [&](const RemovedLandmark& removed) {
    if (!haveCommon(removed.names, names)) return false;
    return std::all_of(names.begin(), names.end(),
                       [&](LandmarkId name) { return name > removed.newest_name || is_removed_name(name); });
  });
}

const LockedLandmark* LandmarkCorrections::lockOf(const std::vector<LandmarkId>& names) const {
  const auto found = std::find_if(locked_.begin(), locked_.end(),
                                  [&](const LockedLandmark& locked) { return haveCommon(locked.names, names); });
  return found == locked_.end() ? nullptr : &*found;
}

void RemovedLandmark::transfer(StateArchive& archive) {
  transferNames(archive, names);
  archive(newest_name, submap, position_m, class_index, radius_m);
  archive.requireName(newest_name);
  archive.requireClass(class_index);
  archive.require(!names.empty() && names.back() <= newest_name && !submap.isNone() && radius_m >= 0.0,
                  "a removed landmark without a place");
}

void LockedLandmark::transfer(StateArchive& archive) {
  transferNames(archive, names);
  archive(landmark);
}

void LandmarkCorrections::transfer(StateArchive& archive) {
  archive(removed_, locked_);
}

}  // namespace semantic_mht_slam
