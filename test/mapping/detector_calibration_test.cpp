#include "semantic_mht_slam/mapping/detector_calibration.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

ClassTable makeNoisyTable(double stddev_m) {
  std::vector<ClassInfo> classes(1);
  classes[0].name = "pole";
  classes[0].range_stddev_m = stddev_m;
  classes[0].lateral_stddev_m = stddev_m;
  return ClassTable(classes, "test");
}

/// Drives 300 m past objects 10 m apart; noise along the line of sight, across it and vertically.
DetectorCalibration drive(const Eigen::Vector3d& noise_m, double wander_m_per_m, double clutter_per_frame,
                          double table_stddev_m = 0.5) {
  DetectorCalibration calibration({}, makeNoisyTable(table_stddev_m));
  Rng rng(1);
  for (int f = 0; f < 300; ++f) {
    const Pose T_odom_base{expRotation({0.0, 0.0, 0.01 * f}), {static_cast<double>(f), 0.0, 0.0}};
    Detections detections;
    for (int i = -5; i < 40; ++i) {
      const Eigen::Vector3d in_odom(10.0 * i + wander_m_per_m * f, i % 2 == 0 ? 8.0 : -8.0, 0.0);
      const Eigen::Vector3d in_base = T_odom_base.inverse() * in_odom;
      const double range_m = in_base.head<2>().norm();
      if (range_m > 40.0) continue;
      const Eigen::Vector3d ray = in_base / range_m;
      const Eigen::Vector3d across(-ray.y(), ray.x(), 0.0);
      Detection detection;
      detection.position_m = in_base + rng.normal(0.0, noise_m[0]) * ray + rng.normal(0.0, noise_m[1]) * across +
                             Eigen::Vector3d(0.0, 0.0, rng.normal(0.0, noise_m[2]));
      detections.push_back(detection);
    }
    for (std::uint64_t n = rng.poisson(clutter_per_frame); n > 0; --n) {
      Detection detection;
      detection.position_m = {rng.uniform(-40.0, 40.0), rng.uniform(-40.0, 40.0), 0.0};
      detections.push_back(detection);
    }
    calibration.add(T_odom_base, detections);
  }
  return calibration;
}

TEST(DetectorCalibrationTest, FindsTheNoiseWhateverTheClassTableSaid) {
  for (const Eigen::Vector3d& noise_m : {Eigen::Vector3d(0.05, 0.05, 0.05), Eigen::Vector3d(0.6, 0.2, 0.1)}) {
    const DetectorCalibration calibration = drive(noise_m, 0.0, 0.0);
    for (const double range_m : {10.0, 20.0, 30.0}) {
      const Eigen::Vector3d found_m = calibration.noiseStddev(0, range_m);
      for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(found_m[i], noise_m[i], 0.2 * noise_m[i]) << range_m << " m, direction " << i;
    }
  }
}

TEST(DetectorCalibrationTest, TheNoiseOfAWideClassIsNotCutShortByTheReachOfTheComparison) {
  const Eigen::Vector3d found_m = drive({1.9, 1.9, 0.95}, 0.0, 0.0, 1.9).noiseStddev(0, 20.0);
  EXPECT_NEAR(found_m[0], 1.9, 0.2);
  EXPECT_NEAR(found_m[1], 1.9, 0.2);
}

TEST(DetectorCalibrationTest, ClutterHardlyChangesIt) {
  const DetectorCalibration calibration = drive({0.1, 0.1, 0.1}, 0.0, 3.0);
  EXPECT_NEAR(calibration.noiseStddev(0, 20.0)[0], 0.1, 0.03);
}

TEST(DetectorCalibrationTest, CentroidsThatWanderAreToldFromNoisyOnes) {
  const double still = drive({0.1, 0.1, 0.1}, 0.0, 0.0).wanderVariancePerMetre(0);
  const double wandering = drive({0.1, 0.1, 0.1}, 0.1, 0.0).wanderVariancePerMetre(0);
  EXPECT_LT(still, 0.002);
  EXPECT_GT(wandering, 0.02);
}

TEST(DetectorCalibrationTest, SwitchedOffItKeepsTheClassTable) {
  CalibrationConfig config;
  config.enabled = false;
  DetectorCalibration calibration(config, makeNoisyTable(0.5));
  Detection detection;
  detection.position_m = {10.0, 0.0, 0.0};
  for (int i = 0; i < 100; ++i) calibration.add(Pose::identity(), {detection});
  EXPECT_NEAR(calibration.noiseStddev(0, 10.0)[0], 0.5, 0.025);
  EXPECT_EQ(calibration.wanderVariancePerMetre(0), 0.0);
}

TEST(RunningMedianTest, IsTheMedianWithinABin) {
  RunningMedian median;
  for (int i = 1; i <= 101; ++i) median.add(0.01 * i);
  EXPECT_NEAR(median.median(), 0.51, 0.03);
}

TEST(DetectorCalibrationTest, ObjectsThatAreNeverSeenTwiceInARowTeachNothing) {
  DetectorCalibration calibration({}, makeNoisyTable(0.05));
  for (int f = 0; f < 300; ++f) {
    Detections detections(f % 10 < 2 ? 1 : 0);  // one of two that stand side by side, then the other
    for (Detection& detection : detections) detection.position_m = {5.0, f % 10 == 0 ? 0.1 : -0.1, 0.0};
    if (f % 10 >= 2) continue;
    calibration.add(Pose::identity(), detections);
    for (int k = 0; k < 12 && f % 10 == 1; ++k) {
      Detections elsewhere(1);
      elsewhere[0].position_m = {5.0, 20.0 + 10.0 * (f + k), 0.0};
      calibration.add(Pose::identity(), elsewhere);
    }
  }
  EXPECT_TRUE(calibration.noiseStddev(0, 5.0).isApprox(Eigen::Vector3d::Constant(0.05), 0.05))
      << calibration.noiseStddev(0, 5.0).transpose();
}

}  // namespace
}  // namespace semantic_mht_slam
