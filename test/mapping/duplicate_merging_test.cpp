#include "semantic_mht_slam/mapping/duplicate_merging.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

MixtureLandmark makeLandmark(LandmarkId id, double x, int observations, ClassIndex class_index = 0) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position = {{x, 0.0, 0.0}, 0.01 * Eigen::Matrix3d::Identity()};
  landmark.components = {{1.0, landmark.position}};
  landmark.class_probs = ClassProbs::Zero(2);
  landmark.class_probs[class_index] = 1.0;
  landmark.observations = observations;
  landmark.existence_prob = 0.9;
  return landmark;
}

/// Thirty frames; landmark 1 in all, landmark 2 where `is_seen` says so.
template <class Predicate>
std::vector<FusedAssociations> makeFrames(const Predicate& is_seen) {
  std::vector<FusedAssociations> frames;
  for (std::size_t f = 0; f < 30; ++f) {
    FusedAssociations frame{f, {}};
    if (f % 5 != 0) frame.landmark_of_measurement.push_back(1);
    if (is_seen(f)) frame.landmark_of_measurement.push_back(2);
    frames.push_back(frame);
  }
  return frames;
}

Eigen::Matrix3d detectorCov(ClassIndex) {
  return 0.25 * Eigen::Matrix3d::Identity();
}

TEST(DuplicateMergingTest, NamesThatAlternateAtOnePlaceAreOneObject) {
  std::vector<MixtureLandmark> landmarks = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 6)};
  const auto merged =
      mergeDuplicates({}, makeFrames([](std::size_t f) { return f % 5 == 0; }), {}, detectorCov, landmarks);
  ASSERT_EQ(merged.size(), 1U);
  EXPECT_EQ(merged[0].first, 2U);
  EXPECT_EQ(merged[0].second, 1U);
  ASSERT_EQ(landmarks.size(), 1U);
  EXPECT_EQ(landmarks[0].observations, 30);
  EXPECT_NEAR(landmarks[0].position.mean_m.x(), 0.25, 1e-9);
}

TEST(DuplicateMergingTest, ObjectsThatAreSeenTogetherStayTwo) {
  std::vector<MixtureLandmark> landmarks = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 24)};
  EXPECT_TRUE(
      mergeDuplicates({}, makeFrames([](std::size_t f) { return f % 5 != 0; }), {}, detectorCov, landmarks).empty());
  EXPECT_EQ(landmarks.size(), 2U);
}

TEST(DuplicateMergingTest, OtherPlacesAndOtherClassesStayTwo) {
  const auto frames = makeFrames([](std::size_t f) { return f % 5 == 0; });
  std::vector<MixtureLandmark> apart = {makeLandmark(1, 0.0, 24), makeLandmark(2, 5.0, 6)};
  EXPECT_TRUE(mergeDuplicates({}, frames, {}, detectorCov, apart).empty());
  std::vector<MixtureLandmark> other_class = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 6, 1)};
  EXPECT_TRUE(mergeDuplicates({}, frames, {}, detectorCov, other_class).empty());
}

TEST(DuplicateMergingTest, NothingIsMergedWhenSwitchedOff) {
  DuplicateConfig config;
  config.merge = false;
  std::vector<MixtureLandmark> landmarks = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 6)};
  EXPECT_TRUE(mergeDuplicates(config, makeFrames([](std::size_t f) { return f % 5 == 0; }), {}, detectorCov, landmarks)
                  .empty());
}

TEST(DuplicateMergingTest, WhatAFrameShowsSideBySideStaysTwoHoweverSeldom) {
  const auto frames = makeFrames([](std::size_t f) { return f % 5 == 0 || f == 7; });
  SideBySide seen;
  seen.add({{7, 0, 1}, {7, 1, 2}}, {});
  std::vector<MixtureLandmark> landmarks = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 7)};
  EXPECT_TRUE(mergeDuplicates({}, frames, seen, detectorCov, landmarks).empty());
  SideBySide parts;
  parts.add({{7, 0, 1}, {7, 1, 2}}, {{1, 2, 1}});
  EXPECT_EQ(mergeDuplicates({}, frames, parts, detectorCov, landmarks).size(), 1U) << "two parts of one object";
}

}  // namespace
}  // namespace semantic_mht_slam
