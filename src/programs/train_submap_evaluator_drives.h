#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/place/submap_features.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// A submap of a drive whose truth is known.
struct DrivenSubmap {
  std::optional<SubmapFeatures> features;  ///< empty without landmarks
  bool is_revisit = false;                 ///< a place in it had been driven through before
  bool is_good = false;  ///< and enough of its landmarks are in the map from there: a true loop closure
};

/// A drive to learn from or to test on.
struct LabelledDrive {
  std::string name;
  std::vector<DrivenSubmap> submaps;
};

/// Landmarks that two passes of a place must have in common for a loop closure to be found and verified.
constexpr int kMinCommonLandmarks = 5;

/// Simulates a scenario file and maps the drive. Throws InputError or ConfigError.
LabelledDrive simulateLabelledDrive(const std::string& scenario, std::uint64_t seed, const SlamConfig& config,
                                    const ClassTable& classes);

/// Maps a recorded drive. Throws InputError if it has no ground truth (poses.txt).
LabelledDrive readLabelledDrive(const DatasetFiles& files, const SlamConfig& config, const ClassTable& classes);

}  // namespace semantic_mht_slam
