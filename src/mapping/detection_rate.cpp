#include "semantic_mht_slam/mapping/detection_rate.h"

#include <algorithm>
#include <cmath>

namespace semantic_mht_slam {

void describe(DetectionConfig& config, Fields& fields) {
  fields.add("missed_detections", config.missed_detections,
             "Whether landmarks that should be seen and are not lose existence (the paper: false).");
  fields.add("detection_prob", config.detection_prob, "", {0.01, 0.999},
             "P_D close to the sensor, before it is known.");
  fields.add("half_range", config.half_range_m, "m", {1.0, 1000.0}, "Range at which P_D has fallen to half.");
  fields.add("max_range", config.max_range_m, "m", {1.0, 1000.0},
             "Landmarks beyond this are not expected to be seen, and rest while a submap comes nowhere so near.");
  fields.add("prior_samples", config.prior_samples, "frames", {1.0, 1e12},
             "How much that curve counts against what is seen, in each cell of class, range and bearing.");
  fields.add("visibility_switch_prob", config.visibility_switch_prob, "1/frame", {0.0001, 0.5},
             "Chance that a landmark in range gets hidden, or comes out again, from one frame to the next.");
  fields.add("birth_prob", config.birth_prob, "", {0.001, 0.999},
             "Existence probability of a landmark seen once, before it is known (see clutter.learn).");
  fields.add("keep_prob", config.keep_prob, "", {0.001, 0.999}, "Landmarks below this existence do not reach the map.");
  fields.add("forget_prob", config.forget_prob, "", {1e-6, 0.999},
             "Landmarks below this existence are dropped from a hypothesis.");
}

DetectionRate::DetectionRate(const DetectionConfig& config, int class_count)
    : config_(config), cells_(static_cast<std::size_t>(class_count * PolarCells::kCount)) {}

std::size_t DetectionRate::cellOf(ClassIndex class_index, const Eigen::Vector3d& position_m) const {
  const int cell = PolarCells::cellOf(position_m, config_.max_range_m);
  return static_cast<std::size_t>(class_index * PolarCells::kCount + cell);
}

void DetectionRate::add(ClassIndex class_index, const Eigen::Vector3d& position_m, bool is_detected) {
  const double range_m = position_m.head<2>().norm();
  if (range_m > config_.max_range_m) return;
  Cell& cell = cells_[cellOf(class_index, position_m)];
  cell.frames += 1.0;
  if (is_detected) cell.detected += 1.0;
}

double DetectionRate::priorProb(double range_m) const {
  const double ratio = range_m / config_.half_range_m;
  return config_.detection_prob / (1.0 + ratio * ratio * ratio * ratio);
}

double DetectionRate::prob(ClassIndex class_index, const Eigen::Vector3d& position_m) const {
  const double range_m = position_m.head<2>().norm();
  if (range_m > config_.max_range_m) return 0.0;
  const Cell& cell = cells_[cellOf(class_index, position_m)];
  return (cell.detected + config_.prior_samples * priorProb(range_m)) / (cell.frames + config_.prior_samples);
}

}  // namespace semantic_mht_slam
