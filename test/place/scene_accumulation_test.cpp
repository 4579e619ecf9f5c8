#include "semantic_mht_slam/place/scene_accumulation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

#include "scene_test_util.h"

namespace semantic_mht_slam {
namespace {

const ClassTable kClasses = makeStreetClasses();
constexpr double kLeast_m = 0.1;
constexpr double kAlong_m = 0.1;
constexpr double kAcross_m = 0.03;

/// What a detector at the origin sees of objects on the x axis, whose ranges it knows less well than their directions.
Detection seenAt(const Eigen::Vector3d& position_m, ClassIndex class_index, Rng& rng) {
  Detection detection;
  detection.class_index = class_index;
  detection.position_m =
      position_m + Eigen::Vector3d(kAlong_m * rng.normal(), kAcross_m * rng.normal(), kAcross_m * rng.normal());
  detection.cov_m2 = Eigen::Vector3d(kAlong_m, kAcross_m, kAcross_m).cwiseAbs2().asDiagonal();
  return detection;
}

TEST(SceneAccumulationTest, AnObjectThatIsSeenOftenIsOneHoweverItScattersAlongTheLineOfSight) {
  Rng rng(1);
  for (int drive = 0; drive < 50; ++drive) {
    std::vector<SeenFrame> frames(25);
    for (SeenFrame& frame : frames) frame.detections = {seenAt({5.0, 0.0, 0.0}, 0, rng)};
    const Scene scene = accumulateScene(frames, kClasses, kLeast_m);
    ASSERT_EQ(scene.objects.size(), 1U) << drive;
    EXPECT_LT((scene.objects[0].position_m - Eigen::Vector3d(5.0, 0.0, 0.0)).norm(), 0.1);
    EXPECT_NEAR(std::sqrt(scene.objects[0].cov_m2(0, 0)), kAlong_m / 5.0, 0.005);
  }
}

TEST(SceneAccumulationTest, WhatOneFrameShowsSideBySideAreTwo) {
  Rng rng(2);
  std::vector<SeenFrame> frames(25);
  for (SeenFrame& frame : frames) {
    frame.detections = {seenAt({5.0, 0.0, 0.0}, 0, rng), seenAt({5.3, 0.0, 0.0}, 0, rng)};
  }
  EXPECT_EQ(accumulateScene(frames, kClasses, kLeast_m).objects.size(), 2U);
}

TEST(SceneAccumulationTest, AnObjectThatIsMistakenNowAndThenIsOneOfTheClassThatItIs) {
  Rng rng(3);
  std::vector<SeenFrame> frames(25);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].detections = {seenAt({5.0, 0.0, 0.0}, i % 9 == 0 ? 1 : 0, rng)};
  }
  const Scene scene = accumulateScene(frames, kClasses, kLeast_m);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_EQ(scene.objects[0].class_index, 0);
}

TEST(SceneAccumulationTest, WhatTheOdometryMayBeOffByJoinsSightingsAndStaysInTheirCovariance) {
  Rng rng(4);
  std::vector<SeenFrame> frames(20);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    frames[i].detections = {seenAt({5.0, i < 10 ? 0.5 : 0.0, 0.0}, 0, rng)};
    frames[i].drift.heading_rad2 = i < 10 ? 0.01 : 0.0001;
  }
  const Scene scene = accumulateScene(frames, kClasses, kLeast_m);
  ASSERT_EQ(scene.objects.size(), 1U);
  EXPECT_LT(std::abs(scene.objects[0].position_m.y()), 0.1) << "the newest frames know better";
  EXPECT_NEAR(std::sqrt(scene.objects[0].cov_m2(1, 1)), 0.05, 0.01) << "as far as the newest frames may be off";
  for (SeenFrame& frame : frames) frame.drift = {};
  EXPECT_EQ(accumulateScene(frames, kClasses, kLeast_m).objects.size(), 2U);
}

}  // namespace
}  // namespace semantic_mht_slam
