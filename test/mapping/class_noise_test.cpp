#include "semantic_mht_slam/mapping/class_noise.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/mapping/hypothesis.h"

namespace semantic_mht_slam {
namespace {

/// Seen at 10 m ahead of a base that is turned by 90 degrees; class 0 is narrow, class 1 wide.
Measurement makeMeasurement(ClassIndex detected) {
  const auto noise = std::make_shared<std::vector<ClassNoise>>();
  noise->push_back({{0.1, 0.2, 0.3}, {0.1, 0.4, 0.9}, 0.0});
  noise->push_back({{1.0, 2.0, 3.0}, {9.0, 36.0, 81.0}, 0.5});
  const ClassNoise& own = noise->at(static_cast<std::size_t>(detected));
  Measurement measurement;
  measurement.ray_m = {10.0, 0.0, 0.0};
  measurement.R_submap_base = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ());
  measurement.noise_stddev_m = own.stddev_m;
  measurement.pose_cov_m2 = 0.25 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d R = measurement.R_submap_base.toRotationMatrix();
  measurement.cov_m2 = R * own.stddev_m.cwiseAbs2().asDiagonal() * R.transpose() + measurement.pose_cov_m2;
  measurement.class_index = detected;
  measurement.outlier_cov_m2 = R * own.outlier_variance_m2.asDiagonal() * R.transpose();
  measurement.wander_variance_per_m = own.wander_variance_per_m;
  measurement.noise_of_class = noise;
  return measurement;
}

Measurement seenAs(ClassIndex object_class, const Measurement& measurement) {
  Measurement changed;
  return ofObject(measurement, object_class, changed);
}

TEST(ClassNoiseTest, ADetectionOfAWideObjectIsWideWhateverItIsCalled) {
  const Measurement wide = seenAs(1, makeMeasurement(0));
  const Measurement expected = makeMeasurement(1);
  EXPECT_TRUE(wide.cov_m2.isApprox(expected.cov_m2, 1e-12)) << wide.cov_m2;
  EXPECT_TRUE(wide.noise_stddev_m.isApprox(expected.noise_stddev_m, 1e-12));
  EXPECT_TRUE(wide.outlier_cov_m2.isApprox(expected.outlier_cov_m2, 1e-12)) << wide.outlier_cov_m2;
  EXPECT_EQ(wide.wander_variance_per_m, 0.5);
  EXPECT_EQ(wide.class_index, 0);
}

TEST(ClassNoiseTest, ThereAndBackIsTheSame) {
  const Measurement narrow = seenAs(0, makeMeasurement(1));
  EXPECT_TRUE(narrow.cov_m2.isApprox(makeMeasurement(0).cov_m2, 1e-12));
  EXPECT_TRUE(seenAs(1, makeMeasurement(1)).cov_m2.isApprox(makeMeasurement(1).cov_m2, 1e-15));
}

TEST(ClassNoiseTest, NoiseThatTheDetectorStatesStays) {
  Measurement stated = makeMeasurement(0);
  stated.noise_of_class.reset();
  EXPECT_EQ(seenAs(1, stated).cov_m2, stated.cov_m2);
}

}  // namespace
}  // namespace semantic_mht_slam
