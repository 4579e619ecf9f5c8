#include "semantic_mht_slam/place/loop_filter.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

LoopFilterConfig makeConfig() {
  LoopFilterConfig config;
  config.hit_prob = 0.8;
  config.false_hit_prob = 0.2;
  return config;
}

TEST(LoopFilterTest, FirstUpdatesEqualBayesRuleByHand) {
  LoopFilter filter(makeConfig());
  // Prior 0.1; likelihoods 0.8 and 0.2.
  EXPECT_NEAR(filter.update(true), 0.08 / (0.08 + 0.18), 1e-12);
  // Prior 0.9 * 4/13 + 0.1 * 9/13 = 4.5/13.
  EXPECT_NEAR(filter.update(false), (0.2 * 4.5) / (0.2 * 4.5 + 0.8 * 8.5), 1e-12);
}

TEST(LoopFilterTest, OneHitIsNotBelievedSeveralAre) {
  LoopFilter filter(LoopFilterConfig{});
  filter.update(true);
  EXPECT_FALSE(filter.believes());
  filter.update(true);
  filter.update(true);
  EXPECT_TRUE(filter.believes());
}

TEST(LoopFilterTest, ASingleMissDoesNotEndABeliefButManyDo) {
  LoopFilter filter(LoopFilterConfig{});
  for (int i = 0; i < 10; ++i) filter.update(true);
  filter.update(false);
  filter.update(true);
  EXPECT_TRUE(filter.believes());
  for (int i = 0; i < 5; ++i) filter.update(false);
  EXPECT_FALSE(filter.believes());
}

TEST(LoopFilterTest, StaysAProbabilityAndAHitNeverLowersItBelowAMiss) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    LoopFilter filter(LoopFilterConfig{});
    for (int i = 0; i < 200; ++i) {
      LoopFilter if_miss = filter;
      const bool hit = rng.bernoulli(0.5);
      const double prob = filter.update(hit);
      EXPECT_GT(prob, 0.0);
      EXPECT_LT(prob, 1.0);
      EXPECT_GE(prob, if_miss.update(false));
    }
  }
}

TEST(LoopFilterTest, ResetForgetsEverything) {
  LoopFilter filter(makeConfig());
  for (int i = 0; i < 10; ++i) filter.update(true);
  filter.reset();
  EXPECT_EQ(filter.loopProb(), 0.0);
  EXPECT_NEAR(filter.update(true), 4.0 / 13.0, 1e-12);
}

}  // namespace
}  // namespace semantic_mht_slam
