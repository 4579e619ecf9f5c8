#include "semantic_mht_slam/mapping/hypothesis_tree.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "semantic_mht_slam/mapping/fusion.h"

namespace semantic_mht_slam {
namespace {

ClassTable makeTable() {
  std::vector<ClassInfo> classes(2);
  classes[0].name = "pole";
  classes[1].name = "trunk";
  classes[1].id = 1;
  return ClassTable(classes, "test");
}

/// Landmarks so near each other that detections are ambiguous.
std::vector<TrackedLandmarkPtr> makeLandmarks(Rng& rng, int count) {
  std::vector<TrackedLandmarkPtr> landmarks;
  for (int i = 0; i < count; ++i) {
    auto landmark = std::make_shared<TrackedLandmark>();
    landmark->id = static_cast<LandmarkId>(i + 1);
    landmark->position = {{rng.uniform(0.0, 12.0), rng.uniform(0.0, 12.0), 0.0}, 0.1 * Eigen::Matrix3d::Identity()};
    landmark->class_probs = ClassProbs::Constant(2, 0.5);
    landmark->observations = 1 + static_cast<int>(rng.index(5));
    landmark->log_existence_odds = 2.0;
    landmarks.push_back(landmark);
  }
  return landmarks;
}

TreeInput makeInput(Rng& rng, std::size_t frame, int count) {
  TreeInput input;
  input.frame = frame;
  input.driven_m = static_cast<double>(frame);
  input.step_m = 1.0;
  for (int i = 0; i < count; ++i) {
    Measurement measurement;
    measurement.position_m = {rng.uniform(0.0, 12.0), rng.uniform(0.0, 12.0), rng.normal(0.0, 0.2)};
    measurement.cov_m2 = 0.2 * Eigen::Matrix3d::Identity();
    measurement.outlier_variance_m2.setConstant(1.0);
    measurement.class_index = static_cast<ClassIndex>(rng.index(2));
    measurement.row = i;
    measurement.id_if_new = 1000 * (frame + 1) + static_cast<LandmarkId>(i);
    input.measurements.push_back(measurement);
  }
  return input;
}

std::map<LandmarkId, MixtureLandmark> run(std::uint64_t seed, bool is_reversed, std::size_t& hypotheses) {
  Rng rng(seed);
  MultiHypothesisTree tree({}, makeTable());
  std::vector<TrackedLandmarkPtr> landmarks = makeLandmarks(rng, 30);
  if (is_reversed) std::reverse(landmarks.begin(), landmarks.end());
  tree.restart(landmarks);
  Rng tree_rng(7);
  for (std::size_t frame = 0; frame < 6; ++frame) tree.step(makeInput(rng, frame, 15), tree_rng);
  hypotheses = tree.leaves().size();
  std::map<LandmarkId, MixtureLandmark> result;
  for (const MixtureLandmark& landmark : fuseHypotheses(tree.leaves())) result[landmark.id] = landmark;
  return result;
}

TEST(HypothesisTreeTest, OrderOfLandmarksDoesNotChangeTheResult) {
  std::size_t most_hypotheses = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::size_t hypotheses_a = 0;
    std::size_t hypotheses_b = 0;
    const auto a = run(seed, false, hypotheses_a);
    const auto b = run(seed, true, hypotheses_b);
    EXPECT_EQ(hypotheses_a, hypotheses_b) << "seed " << seed;
    most_hypotheses = std::max(most_hypotheses, hypotheses_a);
    ASSERT_EQ(a.size(), b.size()) << "seed " << seed;
    for (const auto& [id, landmark] : a) {
      ASSERT_EQ(b.count(id), 1U) << "seed " << seed;
      EXPECT_LT((landmark.position.mean_m - b.at(id).position.mean_m).norm(), 1e-9);
      EXPECT_NEAR(landmark.existence_prob, b.at(id).existence_prob, 1e-9);
    }
  }
  EXPECT_GT(most_hypotheses, 1U);  // else nothing was ambiguous
}

/// Where the two detections of a frame go that stand `distance_m` from each other, the first one on a well-known pole.
std::vector<LandmarkId> landmarksOfTwoParts(double split_prob, double distance_m, ClassIndex second_class) {
  MapperConfig config;
  config.association.split_prob = split_prob;
  MultiHypothesisTree tree(config, makeTable());
  auto pole = std::make_shared<TrackedLandmark>();
  pole->id = 1;
  pole->position = {Eigen::Vector3d(10.0, 0.0, 0.0), 0.01 * Eigen::Matrix3d::Identity()};
  pole->class_probs = ClassProbs::Zero(2);
  pole->class_probs << 0.99, 0.01;
  pole->observations = 20;
  pole->log_existence_odds = 5.0;
  tree.restart({pole});
  TreeInput input;
  for (const double y_m : {0.0, distance_m}) {
    Measurement measurement;
    measurement.position_m = {10.0, y_m, 0.0};
    measurement.cov_m2 = 0.04 * Eigen::Matrix3d::Identity();
    measurement.outlier_variance_m2.setConstant(0.36);
    measurement.row = static_cast<int>(input.measurements.size());
    measurement.id_if_new = 100 + static_cast<LandmarkId>(measurement.row);
    measurement.class_index = measurement.row == 0 ? 0 : second_class;
    input.measurements.push_back(measurement);
  }
  Rng rng(1);
  tree.step(input, rng);
  return fuseAssociations(tree.leaves()).front().landmark_of_measurement;
}

TEST(HypothesisTreeTest, SecondPartOfAnObjectGoesToItsLandmark) {
  EXPECT_EQ(landmarksOfTwoParts(0.01, 1.0, 0), (std::vector<LandmarkId>{1, 1}));
}

TEST(HypothesisTreeTest, NeighbourTooFarToBeASecondPartIsALandmarkOfItsOwn) {
  EXPECT_EQ(landmarksOfTwoParts(0.01, 4.0, 0), (std::vector<LandmarkId>{1, 101}));
}

TEST(HypothesisTreeTest, NeighbourOfAnotherClassIsALandmarkOfItsOwn) {
  EXPECT_EQ(landmarksOfTwoParts(0.01, 1.75, 0), (std::vector<LandmarkId>{1, 1}));
  EXPECT_EQ(landmarksOfTwoParts(0.01, 1.75, 1), (std::vector<LandmarkId>{1, 101}));
}

TEST(HypothesisTreeTest, WithoutSplitsEveryNeighbourIsALandmarkOfItsOwn) {
  EXPECT_EQ(landmarksOfTwoParts(0.0, 1.0, 0), (std::vector<LandmarkId>{1, 101}));
}

}  // namespace
}  // namespace semantic_mht_slam
