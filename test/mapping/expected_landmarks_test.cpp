#include <algorithm>

#include <gtest/gtest.h>

#include "mapping/hypothesis_tree_test_util.h"

namespace semantic_mht_slam {
namespace {

constexpr LandmarkId kOftenSeen = 201;
constexpr LandmarkId kHardlySeen = 202;
constexpr LandmarkId kUnlikely = 203;

MixtureLandmark earlierPole(LandmarkId id, const Eigen::Vector3d& position_m, int observations) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position = {position_m, 0.01 * Eigen::Matrix3d::Identity()};
  landmark.components = {{1.0, landmark.position}};
  landmark.class_probs = makePole(0.0, 1)->class_probs;
  landmark.existence_prob = 0.99;
  landmark.observations = observations;
  return landmark;
}

/// A tree of one hypothesis with ten poles that an earlier pass has seen 1 m to the side, among three others.
MultiHypothesisTree makeRevisit() {
  Rng rng(5);
  std::vector<HypothesisLandmark> poles;
  EarlierMap earlier;
  const Eigen::Vector3d offset_m(0.0, 1.0, 0.0);
  for (LandmarkId id = 1; id <= 10; ++id) {
    const HypothesisLandmark pole = makePole(rng.uniform(-20.0, 20.0), 50);
    auto tracked = std::make_shared<TrackedLandmark>(*pole);
    tracked->id = id;
    tracked->position.mean_m.y() = rng.uniform(-20.0, 20.0);
    earlier.landmarks.push_back(earlierPole(100 + id, tracked->position.mean_m + offset_m, 80));
    poles.push_back({std::move(tracked), pole.existence});
  }
  earlier.landmarks.push_back(earlierPole(kOftenSeen, {30.0, 3.0, 0.0}, 40));
  earlier.landmarks.push_back(earlierPole(kHardlySeen, {32.0, 9.0, 0.0}, 8));
  earlier.landmarks.push_back(earlierPole(kUnlikely, {34.0, -9.0, 0.0}, 40));
  earlier.landmarks.back().existence_prob = 0.3;
  MultiHypothesisTree tree({}, makeTable());
  tree.restart(poles, earlier);
  return tree;
}

/// The same after a frame without detections, which is the time for an alignment.
MultiHypothesisTree makeAlignedRevisit(Rng& rng) {
  MultiHypothesisTree tree = makeRevisit();
  TreeInput input = makeInputOf({});
  input.driven_m = 10.0;
  tree.step(input, rng);
  return tree;
}

TEST(ExpectedLandmarksTest, WhatAnEarlierPassSawOftenIsExpectedWhereTheOffsetPutsIt) {
  Rng rng(1);
  MultiHypothesisTree tree = makeAlignedRevisit(rng);
  const MapHypothesis& leaf = tree.leaves().front();
  ASSERT_TRUE(leaf.map_offset);
  EXPECT_NEAR(leaf.map_offset->mean.y(), 1.0, 0.1);
  const HypothesisLandmark* expected = findLandmark(kOftenSeen, leaf.landmarks);
  ASSERT_NE(expected, nullptr);
  EXPECT_TRUE((*expected)->is_expected);
  EXPECT_NEAR((*expected)->position.mean_m.y(), 2.0, 0.1);
  EXPECT_EQ(findLandmark(kHardlySeen, leaf.landmarks), nullptr) << "a ghost, perhaps, or a duplicate";
  EXPECT_EQ(findLandmark(kUnlikely, leaf.landmarks), nullptr);
  EXPECT_EQ(findLandmark(101, leaf.landmarks), nullptr) << "that is landmark 1";
  EXPECT_EQ((*findLandmark(1, leaf.landmarks))->earlier, 0);
}

TEST(ExpectedLandmarksTest, WhenSeenTheyBecomeLandmarksOfTheSubmapAndTheOffsetLearns) {
  Rng rng(1);
  MultiHypothesisTree tree = makeAlignedRevisit(rng);
  const double variance_m2 = tree.leaves().front().map_offset->cov(1, 1);
  TreeInput input = makeInputOf({makeMeasurement({30.0, 2.0, 0.0}, 500)}, 1);
  input.driven_m = 10.5;
  tree.step(input, rng);
  const MapHypothesis& leaf = tree.leaves().front();
  EXPECT_EQ(findLandmark(kOftenSeen, leaf.landmarks), nullptr);
  const HypothesisLandmark* seen = findLandmark(500, leaf.landmarks);
  ASSERT_NE(seen, nullptr) << "the id that it would have as a new one";
  EXPECT_FALSE((*seen)->is_expected);
  EXPECT_EQ((*seen)->earlier, 10);
  EXPECT_EQ(leaf.expected_found, 1);
  EXPECT_LT(leaf.map_offset->cov(1, 1), variance_m2);
  EXPECT_TRUE(std::is_sorted(leaf.landmarks.begin(), leaf.landmarks.end(),
                             [](const auto& a, const auto& b) { return a->id < b->id; }));
}

}  // namespace
}  // namespace semantic_mht_slam
