#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// What makes points of one class one object, and which of these objects are large enough to be told.
struct ClusterConfig {
  double tolerance_m = 0.5;   ///< points nearer than this belong together
  double voxel_m = 0.1;       ///< edge of the voxels in which points are counted as one while clusters are sought
  int min_points = 30;        ///< the size rule; points of the scan, not voxels
  double min_height_m = 0.0;  ///< the size rule
  bool is_vertical = false;   ///< poles, trunks: split and merge by vertical axes
};

void describe(ClusterConfig& config, Fields& fields);

/// Split and merge of vertical things.
struct VerticalConfig {
  double merge_distance_m = 0.3;  ///< horizontal, between the axes of two pieces
  double merge_gap_m = 1.0;       ///< vertical, between two pieces
  double split_distance_m = 0.4;  ///< horizontal, between the axes of two things that touch
};

void describe(VerticalConfig& config, Fields& fields);

/// Where objects lie in a label image, and how the lidar's points are assigned to them.
struct ImageConfig {
  int close_px = 9;             ///< closing of a class's mask, edge of the square: the gap between two scan rows
  int min_pixels = 40;          ///< connected components below this are noise
  int border_px = 2;            ///< width of the rim of a blob into which background bleeds
  double max_rim_share = 0.6;   ///< clusters behind another one with more of their points in the rim are background
  double range_gate_mad = 4.0;  ///< points farther from the median range than this many deviations are background
};

void describe(ImageConfig& config, Fields& fields);

/// Parameters of the object extraction. The classes are those of a table, in its order.
struct ExtractionConfig {
  double min_range_m = 1.0;
  double max_range_m = 100.0;
  double sensor_stddev_m = 0.08;    ///< of a centroid whose object were seen as a whole
  double visible_part_ratio = 0.5;  ///< deviation of a centroid over the object's spread, since each view sees a part
  VerticalConfig vertical;
  ImageConfig image;
  std::vector<std::string> class_names;
  std::vector<ClusterConfig> classes;

  ExtractionConfig() = default;

  /// Defaults by kind of class: thin things that keep their place (Dirac transition), things that may drive away, and
  /// extended things.
  explicit ExtractionConfig(const ClassTable& table);
};

void describe(ExtractionConfig& config, Fields& fields);

/// Throws ConfigError naming every class whose voxels are larger than half its tolerance, since neighbours would then
/// fall apart, and a range that is empty.
void requireUsable(const ExtractionConfig& config);

}  // namespace semantic_mht_slam
