#include "semantic_mht_slam/common/random.h"

#include <cmath>
#include <stdexcept>
#include <vector>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr int kDraws = 100000;

TEST(RandomTest, SameSeedGivesTheSameSequenceAndAnotherSeedAnother) {
  Rng a(5);
  Rng b(5);
  Rng c(6);
  bool differs = false;
  for (int i = 0; i < 100; ++i) {
    const std::uint64_t value = a.bits();
    EXPECT_EQ(value, b.bits());
    differs |= value != c.bits();
  }
  EXPECT_TRUE(differs);
}

TEST(RandomTest, SequenceOfSeedOneIsTheReferenceOne) {
  // xoshiro256** seeded by SplitMix64 from 0, computed with Python integers.
  Rng rng(0);
  EXPECT_EQ(rng.bits(), 11091344671253066420ULL);
  EXPECT_EQ(rng.bits(), 13793997310169335082ULL);
  EXPECT_EQ(rng.bits(), 1900383378846508768ULL);
}

TEST(RandomTest, ForksDependOnLabelAndIndexButNotOnWhatWasDrawn) {
  Rng drawn(5);
  drawn.bits();
  drawn.normal();
  EXPECT_EQ(drawn.fork("town").bits(), Rng(5).fork("town").bits());
  EXPECT_NE(Rng(5).fork("town").bits(), Rng(5).fork("route").bits());
  EXPECT_NE(Rng(5).fork("town", 0).bits(), Rng(5).fork("town", 1).bits());
  EXPECT_NE(Rng(5).fork("town").bits(), Rng(6).fork("town").bits());
}

TEST(RandomTest, DistributionsHaveTheirMoments) {
  Rng rng(7);
  double uniform_sum = 0.0;
  double normal_sum = 0.0;
  double normal_squares = 0.0;
  double poisson_sum = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double uniform = rng.uniform();
    ASSERT_GE(uniform, 0.0);
    ASSERT_LT(uniform, 1.0);
    uniform_sum += uniform;
    const double normal = rng.normal();
    normal_sum += normal;
    normal_squares += normal * normal;
    poisson_sum += static_cast<double>(rng.poisson(2.5));
  }
  EXPECT_NEAR(uniform_sum / kDraws, 0.5, 0.005);
  EXPECT_NEAR(normal_sum / kDraws, 0.0, 0.015);
  EXPECT_NEAR(normal_squares / kDraws, 1.0, 0.025);
  EXPECT_NEAR(poisson_sum / kDraws, 2.5, 0.025);
}

TEST(RandomTest, IndexIsUniformAndBadArgumentsThrow) {
  Rng rng(8);
  std::vector<int> counts(7, 0);
  for (int i = 0; i < kDraws; ++i) ++counts[rng.index(counts.size())];
  for (const int count : counts) EXPECT_NEAR(count, kDraws / 7.0, 5.0 * std::sqrt(kDraws / 7.0));
  EXPECT_THROW(rng.index(0), std::invalid_argument);
  EXPECT_THROW(rng.uniform(1.0, 0.0), std::invalid_argument);
  EXPECT_THROW(rng.poisson(-1.0), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
