#include <vector>

#include <gtest/gtest.h>

#include "semantic_mht_slam/mapping/fusion.h"
#include "semantic_mht_slam/mapping/hypothesis_tree.h"

#include "mapping/hypothesis_tree_test_util.h"

namespace semantic_mht_slam {
namespace {

/// Where the two detections of a frame go that stand `distance_m` from each other, the first one on a well-known pole.
std::vector<LandmarkId> landmarksOfTwoParts(double split_prob, double distance_m, ClassIndex second_class) {
  MapperConfig config;
  config.association.split_prob = split_prob;
  MultiHypothesisTree tree(config, makeTable());
  tree.restart({makePole(10.0, 20)});
  TreeInput input;
  input.measurements = {makeMeasurement({10.0, 0.0, 0.0}, 100), makeMeasurement({10.0, distance_m, 0.0}, 101)};
  input.measurements[1].class_index = second_class;
  Rng rng(1);
  tree.step(input, rng);
  return fuseAssociations(tree.leaves()).front().landmark_of_measurement;
}

TEST(SecondPartsTest, SecondPartOfAnObjectGoesToItsLandmark) {
  EXPECT_EQ(landmarksOfTwoParts(0.01, 1.0, 0), (std::vector<LandmarkId>{1, 1}));
}

TEST(SecondPartsTest, NeighbourTooFarToBeASecondPartIsALandmarkOfItsOwn) {
  EXPECT_EQ(landmarksOfTwoParts(0.01, 4.0, 0), (std::vector<LandmarkId>{1, 101}));
}

TEST(SecondPartsTest, NeighbourOfAnotherClassIsALandmarkOfItsOwn) {
  EXPECT_EQ(landmarksOfTwoParts(0.01, 1.75, 0), (std::vector<LandmarkId>{1, 1}));
  EXPECT_EQ(landmarksOfTwoParts(0.01, 1.75, 1), (std::vector<LandmarkId>{1, 101}));
}

TEST(SecondPartsTest, WithoutSplitsEveryNeighbourIsALandmarkOfItsOwn) {
  EXPECT_EQ(landmarksOfTwoParts(0.0, 1.0, 0), (std::vector<LandmarkId>{1, 101}));
}

TEST(SecondPartsTest, WhatNoOtherDetectionShowsHasNoSecondPart) {
  MapperConfig config;
  config.tree.max_hypotheses = 1;
  MultiHypothesisTree tree(config, makeTable());
  tree.restart({makePole(10.0, 1)});
  Rng rng(1);
  tree.step(makeInputOf({makeMeasurement({10.0, 1.7, 0.0}, 100)}), rng);
  EXPECT_EQ(tree.leaves().front().history->landmark_of_measurement, (std::vector<LandmarkId>{100}));
  tree.restart({makePole(10.0, 1)});
  tree.step(makeInputOf({makeMeasurement({10.0, 0.0, 0.0}, 100), makeMeasurement({10.0, 1.7, 0.0}, 101)}), rng);
  EXPECT_EQ(tree.leaves().front().history->landmark_of_measurement, (std::vector<LandmarkId>{1, 1}));
}

/// The likeliest leaf after one frame of two detections: one on the pole, one at `distance_m` from it.
MapHypothesis leafOfTwoParts(double false_positive_density, double distance_m) {
  MapperConfig config;
  config.tree.max_hypotheses = 1;
  config.association.split_prob = 0.01;
  config.association.false_positive_density = false_positive_density;
  MultiHypothesisTree tree(config, makeTable());
  tree.restart({makePole(10.0, 20)});
  Rng rng(1);
  tree.step(makeInputOf({makeMeasurement({10.0, 0.0, 0.0}, 100), makeMeasurement({10.0, distance_m, 0.0}, 101)}), rng);
  return tree.leaves().front();
}

TEST(SecondPartsTest, TheMoreClutterTheFewerSecondParts) {
  EXPECT_EQ(leafOfTwoParts(1.0, 1.75).history->landmark_of_measurement, (std::vector<LandmarkId>{1, 1}));
  EXPECT_NE(leafOfTwoParts(20.0, 1.75).history->landmark_of_measurement, (std::vector<LandmarkId>{1, 1}));
}

TEST(SecondPartsTest, WhereObjectsStandSideBySideADetectionBesideALandmarkIsANeighbour) {
  MapperConfig config;
  config.association.split_prob = 0.01;
  MultiHypothesisTree tree(config, makeTable());
  std::vector<MixtureLandmark> row;
  for (int i = 0; i < 20; ++i) {
    MixtureLandmark pole;
    pole.id = i;
    pole.position.mean_m = {1.0 * i, 0.0, 0.0};
    pole.class_probs = makePole(0.0, 1)->class_probs;
    pole.existence_prob = 1.0;
    row.push_back(pole);
  }
  tree.neighbours().add(SubmapId(0), row, {});
  tree.restart({makePole(10.0, 1)});
  Rng rng(1);
  tree.step(makeInputOf({makeMeasurement({10.0, 0.0, 0.0}, 100), makeMeasurement({10.0, 1.0, 0.0}, 101)}), rng);
  EXPECT_EQ(tree.leaves().front().history->landmark_of_measurement, (std::vector<LandmarkId>{1, 101}));
}

TEST(SecondPartsTest, ASecondPartIsNoLandmarkAndCountsAsAFalsePositive) {
  const MapHypothesis leaf = leafOfTwoParts(1.0, 1.0);
  EXPECT_EQ(leaf.landmarks.size(), 1U);
  EXPECT_EQ(leaf.false_positives, 1);
  EXPECT_EQ(leafOfTwoParts(1.0, 6.0).false_positives, 0);
}

TEST(SecondPartsTest, WhichOfTwoDetectionsIsTheSecondPartIsNoBranch) {
  MapperConfig config;
  config.tree.min_weight = 0.0;
  config.tree.branch_log_ratio = 100.0;
  MultiHypothesisTree tree(config, makeTable());
  tree.restart({makePole(10.0, 20)});
  Rng rng(1);
  tree.step(makeInputOf({makeMeasurement({10.1, 0.0, 0.0}, 100), makeMeasurement({9.9, 0.0, 0.0}, 101)}), rng);
  int both = 0;
  for (const MapHypothesis& leaf : tree.leaves()) {
    both += leaf.history->landmark_of_measurement == std::vector<LandmarkId>{1, 1};
  }
  EXPECT_EQ(both, 1);
}

}  // namespace
}  // namespace semantic_mht_slam
