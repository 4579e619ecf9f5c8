#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/mapping/polar_cells.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

class StateArchive;

constexpr double kLowDetectionProb = 0.01;  ///< below this nothing is expected

/// Detections that did not come: negative evidence.
struct DetectionConfig {
  bool missed_detections = true;
  double detection_prob = 0.6;
  Length half_range_m{35.0};
  Length max_range_m{50.0};
  double prior_samples = 100.0;
  double visibility_switch_prob = 0.03;
  double birth_prob = 0.3;
  double keep_prob = 0.5;
  double forget_prob = 0.02;
};

void describe(DetectionConfig& config, Fields& fields);

/// P_D of a landmark by class, range and bearing: how often landmarks that are known to exist were detected from there.
/// Begins with a curve that falls with the range, as if it had been seen `prior_samples` times in each cell; 0 beyond
/// `max_range`.
class DetectionRate {
 public:
  DetectionRate(const DetectionConfig& config, int class_count);

  /// A landmark that exists, at a place in the base frame, was detected in a frame or not.
  void add(ClassIndex class_index, const Eigen::Vector3d& position_m, bool is_detected);

  /// P_D at a place in the base frame.
  double prob(ClassIndex class_index, const Eigen::Vector3d& position_m) const;

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  struct Cell {
    double detected = 0.0;
    double frames = 0.0;

    void transfer(StateArchive& archive);
  };

  std::size_t cellOf(ClassIndex class_index, const Eigen::Vector3d& position_m) const;
  double priorProb(double range_m) const;

  DetectionConfig config_;
  std::vector<Cell> cells_;
};

}  // namespace semantic_mht_slam
