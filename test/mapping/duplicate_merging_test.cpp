#include "semantic_mht_slam/mapping/duplicate_merging.h"

#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr double kBoxProb = 0.015;

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
    FusedAssociations frame{f, {}, {}};
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
      mergeDuplicates({}, kBoxProb, makeFrames([](std::size_t f) { return f % 5 == 0; }), {}, detectorCov, landmarks);
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
      mergeDuplicates({}, kBoxProb, makeFrames([](std::size_t f) { return f % 5 != 0; }), {}, detectorCov, landmarks)
          .empty());
  EXPECT_EQ(landmarks.size(), 2U);
}

TEST(DuplicateMergingTest, OtherPlacesAndOtherClassesStayTwo) {
  const auto frames = makeFrames([](std::size_t f) { return f % 5 == 0; });
  std::vector<MixtureLandmark> apart = {makeLandmark(1, 0.0, 24), makeLandmark(2, 5.0, 6)};
  EXPECT_TRUE(mergeDuplicates({}, kBoxProb, frames, {}, detectorCov, apart).empty());
  std::vector<MixtureLandmark> other_class = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 6, 1)};
  EXPECT_TRUE(mergeDuplicates({}, kBoxProb, frames, {}, detectorCov, other_class).empty());
}

/// Eight objects of another class, 10 m from each other; none at 0.
std::vector<MixtureLandmark> withSurroundings(std::vector<MixtureLandmark> landmarks) {
  for (LandmarkId i = 0; i < 8; ++i) {
    landmarks.push_back(makeLandmark(10 + i, 10.0, 9));
    landmarks.back().position.mean_m = {10.0 * std::cos(0.25 * M_PI * static_cast<double>(i)),
                                        10.0 * std::sin(0.25 * M_PI * static_cast<double>(i)), 0.0};
  }
  return landmarks;
}

TEST(DuplicateMergingTest, AnObjectUnderTwoClassesInOneFrameIsOne) {
  const auto with_it = [](std::size_t f) { return f % 5 == 1 || f % 5 == 2; };
  std::vector<MixtureLandmark> landmarks = withSurroundings({makeLandmark(1, 0.0, 24), makeLandmark(2, 0.1, 12, 1)});
  const auto merged = mergeDuplicates({}, kBoxProb, makeFrames(with_it), {}, detectorCov, landmarks);
  ASSERT_EQ(merged.size(), 1U);
  EXPECT_EQ(merged[0], SameLandmark(2, 1));
  EXPECT_EQ(landmarks[0].mostLikelyClass(), 0);
  std::vector<MixtureLandmark> without = withSurroundings({makeLandmark(1, 0.0, 24), makeLandmark(2, 0.1, 12, 1)});
  EXPECT_TRUE(mergeDuplicates({}, 0.0, makeFrames(with_it), {}, detectorCov, without).empty()) << "no second boxes";
}

TEST(DuplicateMergingTest, OtherClassesBesideOrAloneStayTwo) {
  const auto with_it = [](std::size_t f) { return f % 5 == 1 || f % 5 == 2; };
  std::vector<MixtureLandmark> beside = withSurroundings({makeLandmark(1, 0.0, 24), makeLandmark(2, 1.5, 12, 1)});
  EXPECT_TRUE(mergeDuplicates({}, kBoxProb, makeFrames(with_it), {}, detectorCov, beside).empty());
  const auto alone = [](std::size_t f) { return f % 5 == 0 || f % 5 == 1; };
  std::vector<MixtureLandmark> there = withSurroundings({makeLandmark(1, 0.0, 24), makeLandmark(2, 0.1, 12, 1)});
  EXPECT_TRUE(mergeDuplicates({}, kBoxProb, makeFrames(alone), {}, detectorCov, there).empty());
}

TEST(DuplicateMergingTest, NothingIsMergedWhenSwitchedOff) {
  DuplicateConfig config;
  config.merge = false;
  std::vector<MixtureLandmark> landmarks = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 6)};
  EXPECT_TRUE(mergeDuplicates(config, kBoxProb, makeFrames([](std::size_t f) { return f % 5 == 0; }), {}, detectorCov,
                              landmarks)
                  .empty());
}

TEST(DuplicateMergingTest, WhatAFrameShowsSideBySideStaysTwoHoweverSeldom) {
  const auto frames = makeFrames([](std::size_t f) { return f % 5 == 0 || f == 7; });
  SideBySide seen;
  seen.add({{7, 0, 1}, {7, 1, 2}}, {});
  std::vector<MixtureLandmark> landmarks = {makeLandmark(1, 0.0, 24), makeLandmark(2, 0.5, 7)};
  EXPECT_TRUE(mergeDuplicates({}, kBoxProb, frames, seen, detectorCov, landmarks).empty());
  SideBySide parts;
  parts.add({{7, 0, 1}, {7, 1, 2}}, {{1, 2, 1}});
  EXPECT_EQ(mergeDuplicates({}, kBoxProb, frames, parts, detectorCov, landmarks).size(), 1U)
      << "two parts of one object";
}

}  // namespace
}  // namespace semantic_mht_slam
