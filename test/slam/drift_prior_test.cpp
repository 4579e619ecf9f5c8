#include "semantic_mht_slam/slam/drift_prior.h"

#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

constexpr double kStep_m = 5.0;

/// A bent way, 0.1 rad a keyframe.
Map bentWay(int count) {
  Map map(0.5);
  std::vector<Keyframe> keyframes;
  GraphUpdate poses;
  Pose pose;
  for (int k = 0; k < count; ++k) {
    Keyframe keyframe;
    keyframe.submap = SubmapId(0);
    keyframe.driven_m = kStep_m * k;
    keyframe.turned_rad = 0.1 * k;
    keyframes.push_back(keyframe);
    poses.T_map_keyframe.push_back(pose);
    pose = pose * Pose{expRotation({0.0, 0.0, 0.1}), {kStep_m, 0.0, 0.0}};
  }
  auto submap = std::make_shared<Submap>();
  submap->id = SubmapId(0);
  map.add(submap, std::move(keyframes));
  map.apply(poses);
  return map;
}

OdometryModel wheels() {
  OdometryModel odometry;
  odometry.noise = {0.1, 0.1, 0.01, 0.0, 0.02, 0.0};
  return odometry;
}

RevisitConfig exactMap() {
  RevisitConfig config;
  config.base_stddev_m = 1e-6;
  config.base_stddev_rad = 1e-9;
  config.max_stddev_m = 1000.0;
  return config;
}

RegistrationPrior after(int keyframes, std::size_t since, const OdometryModel& odometry) {
  const Map map = bentWay(keyframes);
  return driftPrior(map, kStep_m * static_cast<double>(since), map.T_map_keyframes().back(), {}, odometry, exactMap());
}

TEST(DriftPriorTest, IsWhatTheErrorsComeTo) {
  const Map map = bentWay(30);
  const RegistrationPrior prior = after(30, 0, wheels());
  Rng rng(1);
  Eigen::Matrix2d cov = Eigen::Matrix2d::Zero();
  double heading_rad2 = 0.0;
  constexpr int kRuns = 2000;
  for (int run = 0; run < kRuns; ++run) {
    Pose pose;
    for (int k = 0; k < 29; ++k) {
      Pose step{expRotation({0.0, 0.0, 0.1 + rng.normal(0.0, 0.02 * std::sqrt(0.1))}), {kStep_m, 0.0, 0.0}};
      step.translation_m.x() += rng.normal(0.0, 0.1 * std::sqrt(kStep_m));
      step.translation_m.y() += rng.normal(0.0, 0.1 * std::sqrt(kStep_m));
      pose = pose * step;
    }
    const Eigen::Vector2d error_m = (pose.translation_m - map.T_map_keyframes().back().translation_m).head<2>();
    cov += error_m * error_m.transpose() / kRuns;
    heading_rad2 += std::pow(angularDistance(pose.rotation, map.T_map_keyframes().back().rotation), 2) / kRuns;
  }
  EXPECT_NEAR(prior.stddev_xy_m, std::sqrt(cov.eigenvalues().real().maxCoeff()), 0.1 * prior.stddev_xy_m);
  EXPECT_NEAR(prior.stddev_yaw_rad, std::sqrt(heading_rad2), 0.1 * prior.stddev_yaw_rad);
  EXPECT_NEAR(prior.stddev_z_m, 0.01 * std::sqrt(29 * kStep_m), 1e-3) << "height has an error of its own";
}

TEST(DriftPriorTest, BeginsWhereAClosureTiedTheDrive) {
  EXPECT_LT(after(30, 29, wheels()).stddev_xy_m, 1e-5);
  EXPECT_LT(after(30, 20, wheels()).stddev_xy_m, after(30, 10, wheels()).stddev_xy_m);
}

TEST(DriftPriorTest, ScalesThatAreNotKnownCount) {
  OdometryModel odometry;
  odometry.noise = {0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  odometry.systematic.scale_translation.stddev = 0.01;
  const double away_m = bentWay(20).T_map_keyframes().back().translation_m.norm();
  EXPECT_NEAR(after(20, 0, odometry).stddev_xy_m, 0.01 * away_m, 1e-3);
  odometry.systematic.scale_translation.stddev = 0.0;
  odometry.systematic.scale_turn.stddev = 0.03;
  EXPECT_NEAR(after(20, 0, odometry).stddev_yaw_rad, 0.03 * 1.9, 1e-6);
}

TEST(DriftPriorTest, StaysWithinTheLargestSearch) {
  const Map map = bentWay(30);
  RevisitConfig config = exactMap();
  config.max_stddev_m = 0.5;
  EXPECT_EQ(driftPrior(map, 0, map.T_map_keyframes().back(), {}, wheels(), config).stddev_xy_m, 0.5);
}

TEST(DriftPriorTest, WhatIsToldComesOnTop) {
  const RegistrationPrior prior = driftPrior(Pose::identity(), 2.0, {0.0, 0.0}, wheels(), exactMap());
  EXPECT_NEAR(prior.stddev_xy_m, 2.0, 1e-6);
  EXPECT_GT(driftPrior(Pose::identity(), 2.0, {100.0, 0.0}, wheels(), exactMap()).stddev_xy_m, 2.1);
}

}  // namespace
}  // namespace semantic_mht_slam
