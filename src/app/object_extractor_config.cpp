#include "semantic_mht_slam/app/object_extractor_config.h"

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {

void describe(ObjectExtractorConfig& config, Fields& fields) {
  fields.add("label_map", config.label_map,
             "Label map or class table; a path, or the name of a file of the package's config.");
  fields.add<LabelSource>("source", config.source, {{"cloud", LabelSource::kCloud}, {"image", LabelSource::kImage}},
                          "Whether labels are a field of the cloud or an image.");
  fields.add("label_field", config.label_field, "Name of the cloud's field that holds the label ids.");
  fields.add("queue_size", config.queue_size, "messages", {1, 1000},
             "Messages of a topic that may wait; beyond that the oldest is dropped.");
  fields.add("sync_slop", config.sync_slop_s, "s", {0.0, 10.0},
             "Label image, camera info and cloud whose stamps differ by more are not used together.");
  describe(config.extraction, fields);
}

ObjectExtractorSetup makeObjectExtractorSetup(const std::vector<Setting>& settings) {
  ObjectExtractorSetup setup;
  for (const Setting& setting : settings) {
    if (setting.key == "label_map") setup.config.label_map = setting.value;
  }
  setup.labelled = loadLabelledClasses(setup.config.label_map);
  setup.config.extraction = ExtractionConfig(setup.labelled.classes);
  Fields fields;
  describe(setup.config, fields);
  applySettings(settings, fields);
  requireUsable(setup.config.extraction);
  if (setup.config.label_field.empty()) throw ConfigError({"label_field is empty"});
  return setup;
}

void describe(SegmentationNodeConfig& config, Fields& fields) {
  fields.add("label_map", config.label_map, "Label map or class table, for the colours of the preview.");
  fields.add("queue_size", config.queue_size, "messages", {1, 1000},
             "Images that may wait; beyond that the oldest is dropped.");
  describe(config.network, fields);
}

}  // namespace semantic_mht_slam
