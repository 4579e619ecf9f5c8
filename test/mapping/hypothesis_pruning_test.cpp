#include "semantic_mht_slam/mapping/hypothesis_pruning.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

std::vector<MapHypothesis> leavesOf(const std::vector<double>& weights) {
  std::vector<MapHypothesis> leaves;
  for (const double weight : weights) {
    leaves.emplace_back();
    leaves.back().id = leaves.size();
    leaves.back().log_weight = std::log(weight);
  }
  return leaves;
}

std::map<std::uint64_t, double> weightsOf(const std::vector<MapHypothesis>& leaves) {
  std::map<std::uint64_t, double> weights;
  for (const MapHypothesis& leaf : leaves) weights[leaf.id] = std::exp(leaf.log_weight);
  return weights;
}

MapperConfig configWith(Estimator estimator, int max_hypotheses) {
  MapperConfig config;
  config.estimator = estimator;
  config.tree.max_hypotheses = max_hypotheses;
  config.tree.min_weight = 0.0;
  return config;
}

TEST(HypothesisPruningTest, WeightsStayAsTheyAreWhileTheEffectiveSampleSizeIsLarge) {
  const MapperConfig config = configWith(Estimator::kDpmhm, 10);
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<MapHypothesis> leaves = leavesOf({0.31, 0.28, 0.23, 0.18});
    Rng rng(seed);
    pruneHypotheses(config, leaves, rng);
    const auto weights = weightsOf(leaves);
    ASSERT_EQ(weights.size(), 4U);
    EXPECT_NEAR(weights.at(1), 0.31, 1e-12);
    EXPECT_NEAR(weights.at(4), 0.18, 1e-12);
  }
}

TEST(HypothesisPruningTest, FewHypothesesSurviveALowEffectiveSampleSizeAndWeightsAreUnbiased) {
  const MapperConfig config = configWith(Estimator::kDpmhm, 10);
  const std::vector<double> before = {0.85, 0.09, 0.04, 0.02};
  std::vector<double> after(before.size(), 0.0);
  std::size_t survivors = 0;
  constexpr int kRuns = 4000;
  for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
    std::vector<MapHypothesis> leaves = leavesOf(before);
    Rng rng(seed);
    pruneHypotheses(config, leaves, rng);
    survivors += leaves.size();
    for (const auto& [id, weight] : weightsOf(leaves)) after[id - 1] += weight / kRuns;
  }
  EXPECT_LT(survivors, 3U * kRuns);
  for (std::size_t i = 0; i < before.size(); ++i) EXPECT_NEAR(after[i], before[i], 0.006) << i;
}

TEST(HypothesisPruningTest, MhmKeepsTheBestThirdOnceTheTreeIsTooLarge) {
  const MapperConfig config = configWith(Estimator::kMhm, 6);
  Rng rng(1);
  std::vector<MapHypothesis> leaves = leavesOf({0.4, 0.2, 0.15, 0.1, 0.08, 0.07});
  pruneHypotheses(config, leaves, rng);
  EXPECT_EQ(leaves.size(), 6U);
  leaves = leavesOf({0.4, 0.2, 0.15, 0.1, 0.08, 0.04, 0.03});
  pruneHypotheses(config, leaves, rng);
  const auto weights = weightsOf(leaves);
  ASSERT_EQ(weights.size(), 2U);
  EXPECT_NEAR(weights.at(1), 0.4 / 0.6, 1e-12);
  EXPECT_NEAR(weights.at(2), 0.2 / 0.6, 1e-12);
}

TEST(HypothesisPruningTest, UnlikelyHypothesesAreDroppedAndTheRestSumsToOne) {
  MapperConfig config = configWith(Estimator::kDpmhm, 10);
  config.tree.min_weight = 0.1;
  config.tree.ess_ratio = 0.0;
  Rng rng(1);
  std::vector<MapHypothesis> leaves = leavesOf({0.6, 0.32, 0.08});
  pruneHypotheses(config, leaves, rng);
  const auto weights = weightsOf(leaves);
  ASSERT_EQ(weights.size(), 2U);
  EXPECT_NEAR(weights.at(1), 0.6 / 0.92, 1e-12);
}

}  // namespace
}  // namespace semantic_mht_slam
