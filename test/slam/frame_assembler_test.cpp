#include "semantic_mht_slam/slam/frame_assembler.h"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/common/ros_time.h"

namespace semantic_mht_slam {
namespace {

constexpr Stamp kSecond = 1000000000;

StampedPose odometryAt(double seconds) {
  return {stampFromSeconds(seconds), {expRotation({0.0, 0.0, 0.1 * seconds}), {seconds, 0.0, 0.0}}};
}

Detection detectionAt(double x) {
  Detection detection;
  detection.position_m = {x, 1.0, 0.0};
  return detection;
}

std::vector<Frame> takeAll(FrameAssembler& assembler) {
  std::vector<Frame> frames;
  while (auto frame = assembler.next()) frames.push_back(*frame);
  return frames;
}

TEST(FrameAssemblerTest, DetectionsGetTheOdometryInterpolatedToTheirStamp) {
  FrameAssembler assembler({});
  assembler.addOdometry(odometryAt(1.0));
  assembler.addDetections(stampFromSeconds(1.25), {detectionAt(5.0)});
  EXPECT_FALSE(assembler.next()) << "no odometry after the detections yet";
  assembler.addOdometry(odometryAt(2.0));
  const auto frame = assembler.next();
  ASSERT_TRUE(frame);
  EXPECT_NEAR(frame->T_odom_base.translation_m.x(), 1.25, 1e-12);
  EXPECT_NEAR(logRotation(frame->T_odom_base.rotation).z(), 0.125, 1e-12);
  EXPECT_EQ(frame->detections.size(), 1U);
  EXPECT_FALSE(assembler.next());
}

TEST(FrameAssemblerTest, OrderOfArrivalOfTheTwoKindsDoesNotMatter) {
  std::vector<std::vector<Frame>> results;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    FrameAssembler assembler({});
    std::vector<Frame> frames;
    int odometry = 0;
    int detections = 0;
    while (odometry < 50 || detections < 40) {
      // seeds differ in which kind comes first; detections may run 3 s ahead or behind
      const bool is_odometry = detections == 40 || (odometry < 50 && rng.bernoulli(0.5));
      if (is_odometry && odometry - detections < 30) {
        assembler.addOdometry(odometryAt(0.1 * odometry++));
      } else if (detections < 40) {
        assembler.addDetections(stampFromSeconds(0.1 * detections + 0.03), {detectionAt(detections)});
        ++detections;
      } else {
        assembler.addOdometry(odometryAt(0.1 * odometry++));
      }
      for (const Frame& frame : takeAll(assembler)) frames.push_back(frame);
    }
    results.push_back(frames);
  }
  for (const auto& frames : results) {
    ASSERT_EQ(frames.size(), 40U);
    for (std::size_t i = 0; i < frames.size(); ++i) {
      EXPECT_EQ(frames[i].index, i);
      EXPECT_EQ(frames[i].T_odom_base.translation_m, results[0][i].T_odom_base.translation_m);
      EXPECT_EQ(frames[i].detections[0].position_m.x(), static_cast<double>(i));
    }
  }
}

TEST(FrameAssemblerTest, BadOdometryIsDroppedAndCounted) {
  FrameAssembler assembler({});
  EXPECT_TRUE(assembler.addOdometry(odometryAt(1.0)));
  EXPECT_FALSE(assembler.addOdometry(odometryAt(1.0)));
  EXPECT_FALSE(assembler.addOdometry(odometryAt(0.5)));
  StampedPose broken = odometryAt(2.0);
  broken.T_world_base.translation_m.x() = std::nan("");
  EXPECT_FALSE(assembler.addOdometry(broken));
  broken.T_world_base.translation_m.x() = 1e11;
  EXPECT_FALSE(assembler.addOdometry(broken));
  EXPECT_TRUE(assembler.addOdometry(odometryAt(2.0)));
  EXPECT_EQ(assembler.counters().odometry, 2U);
  EXPECT_EQ(assembler.counters().odometry_not_rising, 2U);
  EXPECT_EQ(assembler.counters().odometry_invalid, 2U);
}

TEST(FrameAssemblerTest, WhatRosCannotStampIsDroppedAndCounted) {
  FrameAssembler assembler({});
  for (const Stamp stamp : {Stamp{-1}, kLastStamp + 1, std::numeric_limits<Stamp>::max()}) {
    StampedPose odometry = odometryAt(1.0);
    odometry.stamp = stamp;
    EXPECT_FALSE(assembler.addOdometry(odometry)) << stamp;
    assembler.addDetections(stamp, {detectionAt(5.0)});
  }
  EXPECT_EQ(assembler.counters().odometry_invalid, 3U);
  EXPECT_EQ(assembler.counters().frames_not_rising, 1U);
  EXPECT_EQ(assembler.counters().frames_far_ahead, 2U);
  assembler.addDetections(stampFromSeconds(1.0), {detectionAt(5.0)});
  assembler.addOdometry(odometryAt(1.0));
  EXPECT_EQ(takeAll(assembler).size(), 1U);
}

TEST(FrameAssemblerTest, BadDetectionsAreDroppedOneByOneAndTheRestStays) {
  FrameAssembler assembler({});
  Detections detections(8, detectionAt(1.0));
  detections[0].position_m.y() = std::nan("");
  detections[1].score = -0.5;
  detections[2].cov_m2 = Eigen::Matrix3d::Zero();
  detections[3].score = std::nan("");
  detections[4].size_m = Eigen::Vector3d(-1.0, 1.0, 1.0);
  detections[5].score = 0.5;
  detections[6].position_m.setZero();
  assembler.addDetections(kSecond, detections);
  assembler.addOdometry(odometryAt(1.0));
  const auto frame = assembler.next();
  ASSERT_TRUE(frame);
  ASSERT_EQ(frame->detections.size(), 3U);
  EXPECT_FALSE(frame->detections[0].cov_m2) << "a covariance of zero says that nothing is known of it";
  EXPECT_EQ(assembler.counters().covariances_unknown, 1U);
  EXPECT_EQ(assembler.counters().detections_at_origin, 1U);
  EXPECT_EQ(assembler.counters().detections_invalid, 4U);
  EXPECT_EQ(assembler.counters().detections, 3U);
}

TEST(FrameAssemblerTest, FramesWithoutUsableOdometryAreDroppedAndCounted) {
  FrameAssemblerConfig config;
  config.max_odometry_gap_s = 0.5;
  FrameAssembler assembler(config);
  assembler.addDetections(kSecond / 2, {});
  assembler.addOdometry(odometryAt(1.0));
  assembler.addOdometry(odometryAt(2.0));
  assembler.addDetections(3 * kSecond / 2, {});  // between samples 1 s apart
  assembler.addDetections(kSecond, {});          // older than the frame before
  assembler.addDetections(2 * kSecond, {});
  const auto frames = takeAll(assembler);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_EQ(frames[0].index, 3U);
  EXPECT_EQ(assembler.counters().frames_before_odometry, 1U);
  EXPECT_EQ(assembler.counters().frames_in_odometry_gap, 1U);
  EXPECT_EQ(assembler.counters().frames_not_rising, 1U);
  EXPECT_EQ(assembler.counters().frames, 1U);
}

TEST(FrameAssemblerTest, LateDetectionsFindTheirOdometryAsLongAsItIsKept) {
  FrameAssemblerConfig config;
  config.odometry_history_s = 3.0;
  FrameAssembler assembler(config);
  for (int i = 0; i <= 100; ++i) assembler.addOdometry(odometryAt(0.1 * i));
  assembler.addDetections(stampFromSeconds(6.0), {});
  assembler.addDetections(stampFromSeconds(8.0), {});
  const auto frames = takeAll(assembler);
  ASSERT_EQ(frames.size(), 1U);
  EXPECT_NEAR(frames[0].T_odom_base.translation_m.x(), 8.0, 1e-9);
  EXPECT_EQ(assembler.counters().frames_before_odometry, 1U);
}

TEST(FrameAssemblerTest, OneFrameFarAheadDoesNotMakeTheOthersLate) {
  FrameAssembler assembler({});
  assembler.addOdometry(odometryAt(1.0));
  assembler.addDetections(stampFromSeconds(4e9), {});
  assembler.addDetections(stampFromSeconds(1.0), {});
  EXPECT_EQ(takeAll(assembler).size(), 1U);
  EXPECT_EQ(assembler.counters().frames_far_ahead, 1U);
}

TEST(FrameAssemblerTest, OneFrameAheadOfTheOthersCostsItselfAlone) {
  for (const double ahead_s : {5.0, 3600.0}) {
    for (const bool is_before_odometry : {true, false}) {
      FrameAssembler assembler({});
      if (!is_before_odometry) assembler.addOdometry(odometryAt(0.9));
      assembler.addDetections(stampFromSeconds(1.0 + ahead_s), {});
      for (int i = 1; i <= 10; ++i) assembler.addDetections(stampFromSeconds(1.0 + 0.1 * i), {});
      for (int i = is_before_odometry ? 0 : 1; i <= 20; ++i) assembler.addOdometry(odometryAt(0.9 + 0.1 * i));
      EXPECT_EQ(takeAll(assembler).size(), 10U) << ahead_s << (is_before_odometry ? " before" : " after");
      EXPECT_EQ(assembler.counters().frames_not_rising + assembler.counters().frames_far_ahead, 1U);
    }
  }
}

TEST(FrameAssemblerTest, FramesThatWaitForeverAreBounded) {
  FrameAssemblerConfig config;
  config.max_waiting_frames = 10;
  FrameAssembler assembler(config);
  for (int i = 1; i <= 15; ++i) assembler.addDetections(i * kSecond, {});
  assembler.addOdometry(odometryAt(0.0));
  EXPECT_EQ(assembler.counters().frames_waiting_too_long, 5U);
}

}  // namespace
}  // namespace semantic_mht_slam
