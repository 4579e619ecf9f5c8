#include "semantic_mht_slam/mapping/hypothesis_merging.h"

#include <cmath>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

using History = std::vector<std::vector<LandmarkId>>;

MapHypothesis makeLeaf(double weight, double x_m, const History& history) {
  auto landmark = std::make_shared<TrackedLandmark>();
  landmark->id = 1;
  landmark->position = {{x_m, 0.0, 0.0}, 0.04 * Eigen::Matrix3d::Identity()};
  MapHypothesis leaf;
  leaf.log_weight = std::log(weight);
  leaf.landmarks = {{landmark, {}}};
  for (std::size_t frame = 0; frame < history.size(); ++frame) {
    leaf.history = std::make_shared<AssociationRecord>(AssociationRecord{leaf.history, frame, history[frame], {}});
  }
  return leaf;
}

std::vector<double> mergedWeights(std::vector<MapHypothesis> leaves) {
  mergeEqualHypotheses(leaves);
  std::vector<double> weights;
  for (const MapHypothesis& leaf : leaves) weights.push_back(std::exp(leaf.log_weight));
  return weights;
}

TEST(HypothesisMergingTest, EqualHypothesesBecomeOneWithTheSumOfTheirWeights) {
  const auto weights =
      mergedWeights({makeLeaf(0.5, 3.0, {{1}}), makeLeaf(0.3, 3.0, {{1}}), makeLeaf(0.2, 3.01, {{1}})});
  ASSERT_EQ(weights.size(), 1U);
  EXPECT_NEAR(weights[0], 1.0, 1e-12);
}

TEST(HypothesisMergingTest, LandmarksHalfADeviationApartKeepHypothesesApart) {
  EXPECT_EQ(mergedWeights({makeLeaf(0.5, 3.0, {{1}}), makeLeaf(0.5, 3.1, {{1}})}).size(), 2U);
}

TEST(HypothesisMergingTest, DifferentAssociationsCountForFiveFrames) {
  const History other = {{1, 2}, {1}, {1}, {1}, {1}};
  const History same = {{1, 3}, {1}, {1}, {1}, {1}};
  EXPECT_EQ(mergedWeights({makeLeaf(0.5, 3.0, other), makeLeaf(0.5, 3.0, same)}).size(), 2U);
  History longer_other = other;
  History longer_same = same;
  longer_other.push_back({1});
  longer_same.push_back({1});
  EXPECT_EQ(mergedWeights({makeLeaf(0.5, 3.0, longer_other), makeLeaf(0.5, 3.0, longer_same)}).size(), 1U);
}

}  // namespace
}  // namespace semantic_mht_slam
