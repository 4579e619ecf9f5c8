#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/labelled_classes.h"
#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/perception/extraction_config.h"

namespace semantic_mht_slam {

/// True if a data-set folder has the folders `velodyne` and `labels`, as SemanticKITTI's sequences have.
bool hasLabelledScans(const std::string& folder);

/// Defaults by class, changed by a YAML file (unless its name is empty) and by further settings. Throws InputError or
/// ConfigError.
ExtractionConfig loadExtractionConfig(const ClassTable& classes, const std::string& yaml_path,
                                      const std::vector<Setting>& overrides);

/// What the extraction made of the scans of a folder.
struct ExtractedScans {
  std::vector<DetectorFrame> frames;  ///< one a scan
  std::size_t without_scan = 0;       ///< frames that lack their files
  std::vector<std::string> problems;  ///< the first of each kind: unknown labels, points that are not finite
};

/// Extracts the objects of velodyne/NNNNNN.bin with labels/NNNNNN.label of each frame; frames whose scan or labels are
/// missing have no detector frame. `progress` is called with frames done and all. Throws InputError naming the file, or
/// the folder if no frame has a scan.
ExtractedScans extractScans(const std::string& folder, const std::vector<StampedPose>& frames,
                            const LabelledClasses& labelled, const ExtractionConfig& config,
                            const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace semantic_mht_slam
