#include "semantic_mht_slam/perception/extraction_config.h"

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

ClusterConfig defaultsFor(const ClassInfo& info) {
  ClusterConfig config;
  if (info.transition == Transition::kDirac) {
    config.min_points = 20;
    config.min_height_m = 0.3;
    config.is_vertical = true;
  } else if (info.is_static) {
    config.tolerance_m = 0.6;
    config.voxel_m = 0.3;
    config.min_points = 60;
  } else {
    config.voxel_m = 0.15;
  }
  return config;
}

}  // namespace

ExtractionConfig::ExtractionConfig(const ClassTable& table) {
  for (const ClassInfo& info : table.all()) {
    class_names.push_back(info.name);
    classes.push_back(defaultsFor(info));
  }
}

void describe(ClusterConfig& config, Fields& fields) {
  fields.add("tolerance", config.tolerance_m, "m", {0.01, 10.0}, "Points nearer than this are one object.");
  fields.add("voxel", config.voxel_m, "m", {0.01, 5.0},
             "Edge of the voxels that stand for their points while clusters are sought; well below the tolerance.");
  fields.add("min_points", config.min_points, "points", {1, 1e6}, "Smaller clusters are no objects.");
  fields.add("min_height", config.min_height_m, "m", {0.0, 100.0}, "Lower clusters are no objects.");
  fields.add("vertical", config.is_vertical, "Whether pieces on one vertical axis are merged and two axes split.");
}

void describe(VerticalConfig& config, Fields& fields) {
  fields.add("merge_distance", config.merge_distance_m, "m", {0.0, 10.0},
             "Pieces whose axes are this near in the plane are one vertical thing.");
  fields.add("merge_gap", config.merge_gap_m, "m", {0.0, 10.0}, "Largest vertical gap between such pieces.");
  fields.add("split_distance", config.split_distance_m, "m", {0.1, 10.0},
             "Two upright axes in one cluster that are at least this far apart are two things.");
}

void describe(ImageConfig& config, Fields& fields) {
  fields.add("close", config.close_px, "px", {1, 31}, "Edge of the square that closes gaps in a class's mask.");
  fields.add("min_pixels", config.min_pixels, "px", {1, 1e7}, "Smaller connected components are noise.");
  fields.add("border", config.border_px, "px", {0, 50}, "Width of the rim of a blob into which background bleeds.");
  fields.add("max_rim_share", config.max_rim_share, "", {0.0, 1.0},
             "Points behind a blob's nearest object are background if more than this share of them lies in the rim.");
  fields.add("range_gate", config.range_gate_mad, "", {1.0, 100.0},
             "Points farther from an object's median range than this many robust deviations are background.");
}

void describe(ExtractionConfig& config, Fields& fields) {
  fields.add("min_range", config.min_range_m, "m", {0.0, 1000.0}, "Nearer points are the vehicle itself.");
  fields.add("max_range", config.max_range_m, "m", {1.0, 1000.0}, "Farther points are ignored.");
  fields.add("sensor_stddev", config.sensor_stddev_m, "m", {1e-3, 10.0},
             "Deviation of the centroid of an object that is seen as a whole.");
  fields.add("visible_part", config.visible_part_ratio, "", {0.0, 10.0},
             "Deviation of a centroid over the spread of the object's points, since each view sees another part.");
  fields.group("vertical", config.vertical);
  fields.group("image", config.image);
  for (std::size_t i = 0; i < config.classes.size(); ++i) {
    fields.group("classes." + config.class_names[i], config.classes[i]);
  }
}

void requireUsable(const ExtractionConfig& config) {
  std::vector<std::string> problems;
  if (config.min_range_m >= config.max_range_m) problems.push_back("min_range is not below max_range");
  for (std::size_t i = 0; i < config.classes.size(); ++i) {
    if (config.classes[i].voxel_m <= 0.5 * config.classes[i].tolerance_m) continue;
    problems.push_back("classes." + config.class_names[i] + ".voxel is above half of the tolerance");
  }
  if (!problems.empty()) throw ConfigError(problems);
}

}  // namespace semantic_mht_slam
