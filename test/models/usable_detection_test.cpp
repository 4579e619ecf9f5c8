#include "semantic_mht_slam/models/usable_detection.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

Detection detectionAt(const Eigen::Vector3d& position_m) {
  Detection detection;
  detection.position_m = position_m;
  return detection;
}

Detection detectionWith(const Eigen::Matrix3d& cov_m2) {
  Detection detection = detectionAt({1.0, 2.0, 3.0});
  detection.cov_m2 = cov_m2;
  return detection;
}

Eigen::Matrix3d randomlyTurned(const Eigen::Vector3d& variances_m2, Rng& rng) {
  const Eigen::Matrix3d R = expRotation({rng.normal(), rng.normal(), rng.normal()}).toRotationMatrix();
  const Eigen::Matrix3d cov = R * variances_m2.asDiagonal() * R.transpose();
  return 0.5 * (cov + cov.transpose());
}

TEST(UsableDetectionTest, PositionsThatNoSensorSeesAreNotUsable) {
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 1e6, -1e154, 1e300}) {
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_FALSE(isUsable(detectionAt(value * Eigen::Vector3d::Unit(axis)))) << value << " on axis " << axis;
    }
  }
  EXPECT_TRUE(isUsable(detectionAt({0.0, 0.0, 0.0})));
  EXPECT_TRUE(isUsable(detectionAt({-300.0, 40.0, 2.0})));
}

TEST(UsableDetectionTest, SizesThatNothingHasAreNotUsable) {
  Detection detection = detectionAt({1.0, 2.0, 0.0});
  for (const double value : {std::nan(""), std::numeric_limits<double>::infinity(), 1e6, -1.0, 1e308}) {
    detection.size_m = Eigen::Vector3d(1.0, value, 1.0);
    EXPECT_FALSE(isUsable(detection)) << value;
  }
  detection.size_m = Eigen::Vector3d(0.0, 30.0, 5.0);
  EXPECT_TRUE(isUsable(detection));
}

TEST(UsableDetectionTest, SingularCovariancesAreNotUsableHoweverTheyAreRounded) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Rng rng(seed);
    const double scale = std::exp(rng.uniform(-6.0, 6.0));
    EXPECT_FALSE(isUsable(detectionWith(scale * randomlyTurned({1.0, rng.uniform(0.01, 1.0), 0.0}, rng)))) << seed;
    EXPECT_FALSE(isUsable(detectionWith(scale * randomlyTurned({1.0, 0.5, -1e-3}, rng)))) << seed;
    EXPECT_TRUE(isUsable(detectionWith(scale * randomlyTurned({1.0, 0.5, 1e-6}, rng)))) << seed;
  }
  Eigen::Matrix3d correlated = 0.01 * Eigen::Matrix3d::Identity();
  correlated(0, 1) = correlated(1, 0) = 0.01;  // whose Cholesky factor exists by rounding
  EXPECT_FALSE(isUsable(detectionWith(correlated)));
}

TEST(UsableDetectionTest, CovariancesWhoseDeterminantOverflowsOrVanishesAreNotUsable) {
  for (const double variance : {1e-300, 1e-110, 1e-30, 1e30, 1e110, 1e300}) {
    EXPECT_FALSE(isUsable(detectionWith(variance * Eigen::Matrix3d::Identity()))) << variance;
  }
  for (const double variance : {1e-8, 1.0, 1e6}) {
    EXPECT_TRUE(isUsable(detectionWith(variance * Eigen::Matrix3d::Identity()))) << variance;
  }
}

TEST(UsableDetectionTest, RemovingKeepsTheOrderOfTheOthersAndCounts) {
  Detections detections(4, detectionAt({1.0, 0.0, 0.0}));
  for (int row = 0; row < 4; ++row) detections[static_cast<std::size_t>(row)].row = row;
  detections[0].score = -0.5;
  detections[2].size_m = Eigen::Vector3d(1.0, -1.0, 1.0);
  EXPECT_EQ(removeUnusable(detections), 2U);
  ASSERT_EQ(detections.size(), 2U);
  EXPECT_EQ(detections[0].row, 1);
  EXPECT_EQ(detections[1].row, 3);
}

TEST(UsableDetectionTest, WhatLiesAtExactlyZeroWasNotSeen) {
  Detections detections = {detectionAt({0.0, 0.0, 0.0}), detectionAt({1e-9, 0.0, 0.0}), detectionAt({0.0, 0.0, 0.0})};
  EXPECT_EQ(removeAtOrigin(detections), 2U);
  ASSERT_EQ(detections.size(), 1U);
  EXPECT_EQ(detections[0].position_m.x(), 1e-9);
}

TEST(UsableDetectionTest, CovariancesThatSayNothingAreForgotten) {
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  Detections detections = {detectionWith(-1.0 * unit), detectionWith(9999.0 * unit), detectionWith(0.0 * unit),
                           detectionWith(0.04 * unit), detectionAt({1.0, 2.0, 3.0})};
  EXPECT_EQ(forgetUnknownCovariances(detections), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_FALSE(detections[i].cov_m2) << i;
  EXPECT_TRUE(detections[3].cov_m2);
}

}  // namespace
}  // namespace semantic_mht_slam
