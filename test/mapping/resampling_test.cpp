#include "semantic_mht_slam/mapping/resampling.h"

#include <cmath>
#include <numeric>
#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(ResamplingTest, QuantileIsThatOfTheNormalDistribution) {
  EXPECT_NEAR(normalQuantile(0.9), 1.2816, 1e-4);
  EXPECT_NEAR(normalQuantile(0.99), 2.3263, 1e-4);
  EXPECT_NEAR(normalQuantile(0.5), 0.0, 1e-9);
  EXPECT_THROW(normalQuantile(1.0), std::invalid_argument);
}

TEST(ResamplingTest, BoundEqualsTheValuesOfFox) {
  EXPECT_EQ(std::ceil(kldBound(3, 0.01, 0.1)), 228);
  EXPECT_EQ(std::ceil(kldBound(4, 0.01, 0.1)), 311);
  EXPECT_EQ(std::ceil(kldBound(5, 0.01, 0.1)), 388);
  EXPECT_EQ(kldBound(1, 0.01, 0.1), 1.0);
  EXPECT_THROW(kldBound(3, 0.0, 0.1), std::invalid_argument);
}

TEST(ResamplingTest, EffectiveSampleSizeIsTheCountForEvenWeightsAndOneForASingleOne) {
  EXPECT_NEAR(effectiveSampleSize({0.25, 0.25, 0.25, 0.25}), 4.0, 1e-12);
  EXPECT_NEAR(effectiveSampleSize({1.0, 0.0}), 1.0, 1e-12);
}

TEST(ResamplingTest, EachElementIsDrawnInProportionToItsWeight) {
  const std::vector<std::vector<double>> cases = {
      {0.5, 0.3, 0.15, 0.05}, {0.85, 0.09, 0.04, 0.02}, {0.8, 0.2}, {0.97, 0.01, 0.01, 0.01}, {0.4, 0.35, 0.25}};
  for (const std::vector<double>& weights : cases) {
    for (const std::size_t max_samples : {4UL, 10UL, 200UL}) {
      std::vector<double> share(weights.size(), 0.0);
      constexpr int kRuns = 10000;
      for (std::uint64_t seed = 0; seed < kRuns; ++seed) {
        Rng rng(seed);
        const std::vector<int> counts = kldResample(weights, 0.05, 0.1, max_samples, rng);
        const int samples = std::accumulate(counts.begin(), counts.end(), 0);
        for (std::size_t i = 0; i < weights.size(); ++i) share[i] += static_cast<double>(counts[i]) / samples / kRuns;
      }
      // a share moves by at most one sample of four, of one side or the other: standard error below 0.0013
      for (std::size_t i = 0; i < weights.size(); ++i) {
        EXPECT_NEAR(share[i], weights[i], 0.005) << weights[0] << ", element " << i << ", cap " << max_samples;
      }
    }
  }
}

TEST(ResamplingTest, SamplesStayBelowTheCap) {
  Rng rng(1);
  const std::vector<double> weights(50, 0.02);
  const std::vector<int> counts = kldResample(weights, 0.01, 0.01, 20, rng);
  EXPECT_EQ(std::accumulate(counts.begin(), counts.end(), 0), 20);
}

}  // namespace
}  // namespace semantic_mht_slam
