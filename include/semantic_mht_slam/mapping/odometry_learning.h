#pragma once

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/mapping/odometry_stretch.h"
#include "semantic_mht_slam/mapping/variance_components.h"

namespace semantic_mht_slam {

/// How the odometry's errors are found out while driving.
struct OdometryConfig {
  bool learn = true;
  OdometryNoise noise;
  double prior_factor = 1.5;
  double scale_stddev = 0.03;
  double bend_stddev_rad_per_m = 0.002;
  double direction_stddev_rad = 0.02;
  double lever_stddev_m = 0.2;
  double range_scale_stddev = 0.005;
  double range_offset_stddev_m = 0.02;
};

void describe(OdometryConfig& config, Fields& fields);

/// Finds out how the odometry errs from what the detections of finished stretches say: maximum of the marginal
/// likelihood of the errors of all steps (see `VarianceComponents`), with the configured noise as prior.
class OdometryLearning {
 public:
  explicit OdometryLearning(const OdometryConfig& config);

  /// Takes a stretch of driving with its associations.
  void add(const OdometryStretch& stretch);

  /// What is known now.
  const OdometryModel& model() const { return model_; }

  /// All that it has learned (see `StateArchive`).
  void transfer(StateArchive& archive);

 private:
  void readOff();

  OdometryConfig config_;
  VarianceComponents planar_;
  VarianceComponents vertical_;
  OdometryModel model_;
};

}  // namespace semantic_mht_slam
