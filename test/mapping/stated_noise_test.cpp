#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/mapping/mapper.h"

#include "mapping/mapper_test_util.h"

namespace semantic_mht_slam {
namespace {

/// Poles are known well, trunks badly.
ClassTable makeStatedTable() {
  std::vector<ClassInfo> classes(2);
  classes[0].name = "pole";
  classes[0].range_stddev_m = classes[0].lateral_stddev_m = 0.05;
  classes[1].name = "trunk";
  classes[1].id = 1;
  classes[1].range_stddev_m = classes[1].lateral_stddev_m = 1.0;
  return ClassTable(classes, "test");
}

MapperConfig makeConfig() {
  MapperConfig config;
  config.tree.max_hypotheses = 1;
  config.calibration.enabled = false;
  config.bias.enabled = false;
  return config;
}

/// Covariance of the only landmark after ten frames of a pole, the last of which says `last_class`.
Eigen::Matrix3d covAfterTenFrames(const std::optional<Eigen::Matrix3d>& stated, ClassIndex last_class) {
  Mapper mapper(makeConfig(), makeStatedTable());
  Rng rng(1);
  for (std::size_t frame = 0; frame < 10; ++frame) {
    Detection detection;
    detection.position_m = {10.0, 2.0, 0.0};
    detection.class_index = frame == 9 ? last_class : 0;
    detection.cov_m2 = stated;
    feed(mapper, {frame, static_cast<Stamp>(frame), Pose::identity(), {detection}}, rng);
  }
  const auto& landmarks = mapper.hypotheses().front().landmarks;
  EXPECT_EQ(landmarks.size(), 1U);
  return landmarks.front()->position.cov_m2;
}

TEST(StatedNoiseTest, ACovarianceThatTheDetectorStatesIsUsedAsItIs) {
  const Eigen::Matrix3d stated = Eigen::Vector3d(0.09, 0.04, 0.01).asDiagonal();
  EXPECT_LT((covAfterTenFrames(stated, 0) - 0.1 * stated).norm(), 1e-6);
}

TEST(StatedNoiseTest, TheClassOfTheObjectDoesNotChangeIt) {
  const Eigen::Matrix3d stated = 0.25 * Eigen::Matrix3d::Identity();
  EXPECT_LT((covAfterTenFrames(stated, 1) - covAfterTenFrames(stated, 0)).norm(), 1e-9);
}

TEST(StatedNoiseTest, WithoutOneTheNoiseOfTheObjectsClassIsUsedWhateverTheLabel) {
  const Eigen::Matrix3d as_pole = covAfterTenFrames(std::nullopt, 0);
  EXPECT_NEAR(as_pole(1, 1), 0.1 * 0.05 * 0.05, 1e-4);
  EXPECT_LT((covAfterTenFrames(std::nullopt, 1) - as_pole).norm(), 1e-9);
}

TEST(StatedNoiseTest, LandmarksTurnIntoTheNextSubmapAndGrowByTheOdometryOfTheOneBefore) {
  MapperConfig config = makeConfig();
  config.submap.correct_pose = false;
  Mapper mapper(config, makeStatedTable());
  Rng rng(1);
  Detection detection;
  detection.position_m = {25.0, 2.0, 0.0};
  detection.cov_m2 = Eigen::Vector3d(0.09, 0.04, 0.01).asDiagonal();
  const auto add = [&](std::size_t frame, double x_m, double yaw_rad, const Detections& detections) {
    const Pose T_odom_base{expRotation({0.0, 0.0, yaw_rad}), {x_m, 0.0, 0.0}};
    feed(mapper, {frame, static_cast<Stamp>(frame), T_odom_base, detections}, rng);
  };
  add(0, 0.0, 0.0, {detection});
  add(1, 20.0, 0.0, {});
  add(2, 35.0, M_PI / 2.0, {});
  const auto& landmarks = mapper.hypotheses().front().landmarks;
  ASSERT_EQ(landmarks.size(), 1U);
  EXPECT_LT((landmarks.front()->position.mean_m - Eigen::Vector3d(2.0, 10.0, 0.0)).norm(), 1e-9);
  const MotionVariance odometry = varianceOf(mapper.odometryModel(), {20.0, 0.0});
  const Eigen::Vector3d expected_m2(0.04 + odometry.across_m2, 0.09 + odometry.along_m2, 0.01 + odometry.up_m2);
  const Eigen::Vector3d is_m2 = landmarks.front()->position.cov_m2.diagonal();
  EXPECT_NEAR(is_m2.y(), expected_m2.y(), 1e-2);
  EXPECT_NEAR(is_m2.z(), expected_m2.z(), 1e-6);
  EXPECT_GT(is_m2.x(), expected_m2.x());  // and the heading's, over the way and the range
  EXPECT_LT(is_m2.x(), expected_m2.x() + 400.0 * odometry.heading_rad2);
}

}  // namespace
}  // namespace semantic_mht_slam
