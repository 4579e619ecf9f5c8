#include "semantic_mht_slam/mapping/landmark_tracking.h"

#include <cmath>

#include <gtest/gtest.h>

#include "mapping/hypothesis_tree_test_util.h"

namespace semantic_mht_slam {
namespace {

constexpr double kVariance_m2 = 0.04;
constexpr double kOutlierVariance_m2 = 0.36;
constexpr double kPoseVariance_m2 = 0.09;

/// A pole with the deviation of a tenth of a metre, seen 0.3 m farther away than it is.
Gaussian3 updatedPole(MeasurementModel model, bool is_outlier, bool is_pose_uncertain) {
  MapperConfig config;
  config.measurement_model = model;
  const ClassTable table = makeTable();
  Measurement measurement = makeMeasurement({10.3, 0.0, 0.0}, 100);
  measurement.ray_m = measurement.position_m;
  measurement.noise_stddev_m.setConstant(std::sqrt(kVariance_m2));
  measurement.outlier_cov_m2 = kOutlierVariance_m2 * Eigen::Matrix3d::Identity();
  if (is_pose_uncertain) {
    measurement.pose_cov_m2 = kPoseVariance_m2 * Eigen::Matrix3d::Identity();
    measurement.cov_m2 += measurement.pose_cov_m2;
  }
  Candidate candidate;
  candidate.is_outlier = is_outlier;
  const LandmarkTracking tracking(config, table);
  return tracking.updated(AssociationModel(config, table), makePole(10.0, 5), measurement, {}, candidate, 0.9)
      ->position;
}

TEST(LandmarkTrackingTest, BothMeasurementModelsWeighNoiseOutliersAndPoseAlike) {
  for (const bool is_outlier : {false, true}) {
    for (const bool is_pose_uncertain : {false, true}) {
      const double noise_m2 =
          kVariance_m2 + (is_outlier ? kOutlierVariance_m2 : 0.0) + (is_pose_uncertain ? kPoseVariance_m2 : 0.0);
      const double gain = 0.01 / (0.01 + noise_m2);
      for (const MeasurementModel model : {MeasurementModel::kAdditive, MeasurementModel::kRangeBearing}) {
        const Gaussian3 pole = updatedPole(model, is_outlier, is_pose_uncertain);
        EXPECT_NEAR(pole.mean_m.x(), 10.0 + 0.3 * gain, 2e-3);
        for (int i = 0; i < 3; ++i) EXPECT_NEAR(pole.cov_m2(i, i), (1.0 - gain) * 0.01, 2e-4);
      }
    }
  }
}

}  // namespace
}  // namespace semantic_mht_slam
