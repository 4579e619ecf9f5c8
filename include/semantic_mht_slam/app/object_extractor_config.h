#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/app/labelled_classes.h"
#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/perception/extraction_config.h"
#include "semantic_mht_slam/perception/segmentation_network.h"

namespace semantic_mht_slam {

/// Where labels come from.
enum class LabelSource { kCloud, kImage };

/// Parameters of the object extractor as a ROS node.
struct ObjectExtractorConfig {
  std::string label_map = "labels_semantic_kitti.yaml";
  LabelSource source = LabelSource::kCloud;
  std::string label_field = "label";
  int queue_size = 5;
  double sync_slop_s = 0.05;
  ExtractionConfig extraction;
};

void describe(ObjectExtractorConfig& config, Fields& fields);

/// The classes of the extractor and its parameters, some of which are by class.
struct ObjectExtractorSetup {
  LabelledClasses labelled;
  ObjectExtractorConfig config;
};

/// Reads the label map that the settings name, or the default one, and then all settings. Throws InputError or
/// ConfigError.
ObjectExtractorSetup makeObjectExtractorSetup(const std::vector<Setting>& settings);

/// Parameters of the segmentation node.
struct SegmentationNodeConfig {
  std::string label_map = "labels_cityscapes.yaml";
  int queue_size = 1;
  SegmentationConfig network;
};

void describe(SegmentationNodeConfig& config, Fields& fields);

}  // namespace semantic_mht_slam
