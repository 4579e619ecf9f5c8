#include "semantic_mht_slam/mapping/fusion.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

HypothesisLandmark makeLandmark(LandmarkId id, const Eigen::Vector3d& mean, double variance, double log_odds) {
  auto landmark = std::make_shared<TrackedLandmark>();
  landmark->id = id;
  landmark->position = {mean, variance * Eigen::Matrix3d::Identity()};
  landmark->class_probs = ClassProbs::Constant(2, 0.5);
  landmark->observations = static_cast<int>(id);
  Existence existence;
  existence.log_odds = log_odds;
  return {std::move(landmark), existence};
}

MapHypothesis makeLeaf(double weight, std::vector<HypothesisLandmark> landmarks) {
  MapHypothesis leaf;
  leaf.log_weight = std::log(weight);
  leaf.landmarks = std::move(landmarks);
  return leaf;
}

TEST(FusionTest, MixtureKeepsMeanAndCovarianceOfTheHypotheses) {
  const auto fused = fuseHypotheses({makeLeaf(0.7, {makeLandmark(3, {0.0, 0.0, 0.0}, 0.1, 2.0)}),
                                     makeLeaf(0.3, {makeLandmark(3, {1.0, 0.0, 0.0}, 0.3, 2.0)})});
  ASSERT_EQ(fused.size(), 1U);
  ASSERT_EQ(fused[0].components.size(), 2U);
  EXPECT_TRUE(fused[0].isUndecided());
  EXPECT_NEAR(fused[0].components[0].weight, 0.7, 1e-12);
  EXPECT_NEAR(fused[0].position.mean_m.x(), 0.3, 1e-12);
  // 0.7 * 0.1 + 0.3 * 0.3 within, 0.7 * 0.3^2 + 0.3 * 0.7^2 between
  EXPECT_NEAR(fused[0].position.cov_m2(0, 0), 0.16 + 0.21, 1e-12);
  EXPECT_NEAR(fused[0].position.cov_m2(1, 1), 0.16, 1e-12);
}

TEST(FusionTest, ComponentsThatNearlyCoincideAreOneAndTheMomentsStay) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    std::vector<MapHypothesis> leaves;
    std::vector<MixtureComponent> components;
    for (int i = 0; i < 6; ++i) {  // two places, 2 m apart, with small differences
      const double weight = (i + 1) / 21.0;
      const Eigen::Vector3d mean(i % 2 == 0 ? 0.0 : 2.0, rng.normal(0.0, 0.01), rng.normal(0.0, 0.01));
      const double variance = rng.uniform(0.03, 0.05);
      leaves.push_back(makeLeaf(weight, {makeLandmark(3, mean, variance, 2.0)}));
      components.push_back({weight, {mean, variance * Eigen::Matrix3d::Identity()}});
    }
    const auto fused = fuseHypotheses(leaves);
    ASSERT_EQ(fused.size(), 1U);
    ASSERT_EQ(fused[0].components.size(), 2U);
    EXPECT_NEAR(fused[0].components[0].weight, 12.0 / 21.0, 1e-12);
    EXPECT_NEAR(fused[0].components[1].weight, 9.0 / 21.0, 1e-12);
    EXPECT_TRUE(fused[0].position.mean_m.isApprox(moments(components).mean_m, 1e-12));
    EXPECT_TRUE(fused[0].position.cov_m2.isApprox(moments(components).cov_m2, 1e-12));
  }
}

TEST(FusionTest, HypothesesThatAgreeAreOneComponent) {
  const HypothesisLandmark shared = makeLandmark(3, {1.0, 2.0, 3.0}, 0.1, 0.0);
  const auto fused = fuseHypotheses({makeLeaf(0.6, {shared}), makeLeaf(0.4, {shared})});
  ASSERT_EQ(fused.size(), 1U);
  EXPECT_FALSE(fused[0].isUndecided());
  EXPECT_NEAR(fused[0].components[0].weight, 1.0, 1e-12);
  EXPECT_NEAR(fused[0].existence_prob, 0.5, 1e-12);
}

TEST(FusionTest, ALandmarkDoesNotExistInAHypothesisThatLacksIt) {
  const auto fused = fuseHypotheses({makeLeaf(0.75, {}), makeLeaf(0.25, {makeLandmark(7, {0, 0, 0}, 0.1, 20.0)})});
  ASSERT_EQ(fused.size(), 1U);
  EXPECT_NEAR(fused[0].existence_prob, 0.25, 1e-6);
  EXPECT_NEAR(fused[0].components[0].weight, 1.0, 1e-12);
}

TEST(FusionTest, EachMeasurementGoesToTheLandmarkWithMostWeight) {
  auto first = std::make_shared<AssociationRecord>();
  first->frame = 4;
  first->landmark_of_measurement = {1, 2};
  const auto record = [&](std::vector<LandmarkId> landmarks) {
    auto next = std::make_shared<AssociationRecord>();
    next->previous = first;
    next->frame = 5;
    next->landmark_of_measurement = std::move(landmarks);
    return next;
  };
  std::vector<MapHypothesis> leaves = {makeLeaf(0.4, {}), makeLeaf(0.35, {}), makeLeaf(0.25, {})};
  leaves[0].history = record({1, 8});
  leaves[1].history = record({2, kNoLandmark});
  leaves[2].history = record({2, kNoLandmark});
  const auto fused = fuseAssociations(leaves);
  ASSERT_EQ(fused.size(), 2U);
  EXPECT_EQ(fused[0].frame, 4U);
  EXPECT_EQ(fused[0].landmark_of_measurement, (std::vector<LandmarkId>{1, 2}));
  EXPECT_EQ(fused[1].landmark_of_measurement, (std::vector<LandmarkId>{2, kNoLandmark}));
}

}  // namespace
}  // namespace semantic_mht_slam
