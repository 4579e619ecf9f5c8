#include "semantic_mht_slam/slam/slam.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/ros_time.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

StampedPose odometryAt(int i) {
  return {100000000LL * i, {expRotation({0.0, 0.0, 0.01 * i}), {1.0 * i, 0.0, 0.0}}};
}

TEST(SlamTest, OdometryMethodPassesEveryUsableSampleThrough) {
  Slam slam(defaultsOf(Method::kOdometry), ClassTable{});
  EXPECT_FALSE(latestPoseOf(slam));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(slam.addOdometry(odometryAt(i)));
  StampedPose broken = odometryAt(6);
  broken.T_world_base.rotation.w() = std::nan("");
  EXPECT_FALSE(slam.addOdometry(broken));
  const std::vector<StampedPose> trajectory = trajectoryOf(slam);
  ASSERT_EQ(trajectory.size(), 5U);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(trajectory[static_cast<std::size_t>(i)].stamp, odometryAt(i).stamp);
    EXPECT_EQ(trajectory[static_cast<std::size_t>(i)].T_world_base.translation_m,
              odometryAt(i).T_world_base.translation_m);
  }
  EXPECT_EQ(latestPoseOf(slam)->stamp, odometryAt(4).stamp);
}

TEST(SlamTest, LatestFrameFollowsTheDetections) {
  Slam slam(defaultsOf(Method::kOdometry), ClassTable{});
  Detection detection;
  detection.position_m = {1.0, 2.0, 0.0};
  slam.addDetections(odometryAt(1).stamp, {detection});
  EXPECT_FALSE(slam.parts().latest_frame);
  slam.addOdometry(odometryAt(1));
  ASSERT_TRUE(slam.parts().latest_frame);
  EXPECT_EQ(slam.parts().latest_frame->stamp, odometryAt(1).stamp);
  EXPECT_EQ(slam.parts().latest_frame->detections.size(), 1U);
}

TEST(SlamTest, NothingThatComesInMakesAStateThatCannotBeRead) {
  const ClassTable classes = makeStreetClasses();
  Slam slam(SlamConfig{}, classes);
  SquareDrive(1).feed(slam, 0, 40);
  Detection detection;
  detection.position_m = {1.0, 2.0, 0.0};
  for (const Stamp stamp : {Stamp{-1}, kLastStamp + 1, std::numeric_limits<Stamp>::max()}) {
    EXPECT_FALSE(slam.addOdometry({stamp, SquareDrive::odometryAt(40)})) << stamp;
    slam.addDetections(stamp, {detection});
    EXPECT_NO_THROW(Slam(SlamConfig{}, classes, slam.snapshot())) << stamp;
  }
  EXPECT_FALSE(slam.addOdometry({SquareDrive::stampAt(39) + 1, {Eigen::Quaterniond::Identity(), {1e11, 0.0, 0.0}}}));
  EXPECT_TRUE(slam.addOdometry({SquareDrive::stampAt(40), SquareDrive::odometryAt(40)})) << "the session goes on";
  EXPECT_TRUE(latestCovOf(slam)) << "and is not lost";
}

TEST(SlamTest, FramesThatWaitShowTheirLandmarks) {
  const SquareDrive drive(1);
  Slam slam(SlamConfig{}, makeStreetClasses());
  const auto feedThreeOfEach = [&](int begin, int end) {
    for (int i = begin; i < end; ++i) {
      Detections detections = drive.detectionsAt(i);
      detections.resize(std::min<std::size_t>(detections.size(), 3));
      slam.addOdometry({SquareDrive::stampAt(i), SquareDrive::odometryAt(i)});
      slam.addDetections(SquareDrive::stampAt(i), detections);
    }
  };
  feedThreeOfEach(0, 6);
  ASSERT_FALSE(slam.parts().is_fitted);
  const std::vector<MixtureLandmark> ahead = provisionalLandmarksOf(slam);
  ASSERT_GE(ahead.size(), 2U);
  feedThreeOfEach(6, 12);
  ASSERT_TRUE(slam.parts().is_fitted);
  const std::vector<MixtureLandmark> mapped = provisionalLandmarksOf(slam);
  for (const MixtureLandmark& landmark : ahead) {
    const MixtureLandmark* same = findLandmark(landmark.id, mapped);
    ASSERT_NE(same, nullptr) << landmark.id;
    EXPECT_LT((same->position.mean_m - landmark.position.mean_m).norm(), 0.5);
  }
}

TEST(SlamTest, WhatTheOpenSubmapSawIsKnownBeforeItIsFinished) {
  Slam slam(SlamConfig{}, makeStreetClasses());
  SquareDrive(1).feed(slam, 0, 30);
  ASSERT_TRUE(slam.map().submaps().empty());
  const std::vector<MixtureLandmark> provisional = provisionalLandmarksOf(slam);
  ASSERT_GT(provisional.size(), 3U);
  EXPECT_TRUE(landmarksOf(slam).empty());
  slam.finish();
  EXPECT_TRUE(provisionalLandmarksOf(slam).empty());
  const std::vector<MixtureLandmark> finished = landmarksOf(slam);
  ASSERT_EQ(finished.size(), provisional.size());
  for (std::size_t i = 0; i < finished.size(); ++i) {
    EXPECT_EQ(finished[i].id, provisional[i].id);
    EXPECT_LT((finished[i].position.mean_m - provisional[i].position.mean_m).norm(), 0.3);
  }
  SquareDrive(1).feed(slam, 30, 32);
  for (const MixtureLandmark& landmark : provisionalLandmarksOf(slam)) {
    EXPECT_EQ(findLandmark(landmark.id, finished), nullptr) << "the map has it";
  }
}

}  // namespace
}  // namespace semantic_mht_slam
