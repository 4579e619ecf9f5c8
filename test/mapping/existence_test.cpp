#include "semantic_mht_slam/mapping/existence.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr double kDetectionProb = 0.6;
constexpr double kSwitchProb = 0.03;

TEST(ExistenceTest, ALongOcclusionCostsLittleMoreThanAShortOne) {
  Existence landmark;
  for (int i = 0; i < 20; ++i) applyMiss(landmark, kDetectionProb, kSwitchProb);
  const double after_short = landmark.log_odds;
  for (int i = 0; i < 80; ++i) applyMiss(landmark, kDetectionProb, kSwitchProb);
  EXPECT_LT(after_short, -2.0) << "not being seen is evidence";
  EXPECT_GT(landmark.log_odds, after_short - 5.0) << "but a hidden object stays hidden";
}

TEST(ExistenceTest, HitsInARowSayMoreThanTheSameHitsWithMissesBetween) {
  Existence in_a_row;
  Existence scattered;
  for (int i = 0; i < 3; ++i) {
    applyHit(in_a_row, kDetectionProb, kSwitchProb, 5.0, 100.0);
    applyHit(scattered, kDetectionProb, kSwitchProb, 5.0, 100.0);
    for (int k = 0; k < 30; ++k) applyMiss(scattered, kDetectionProb, kSwitchProb);
  }
  EXPECT_GT(in_a_row.log_odds, scattered.log_odds + 5.0);
}

TEST(ExistenceTest, OddsAreCappedSoThatTheyCanFall) {
  Existence landmark;
  for (int i = 0; i < 100; ++i) applyHit(landmark, kDetectionProb, kSwitchProb, 5.0, 8.0);
  EXPECT_EQ(landmark.log_odds, 8.0);
}

TEST(ExistenceTest, BeyondTheDetectorsReachNothingIsLearnt) {
  Existence landmark;
  for (int i = 0; i < 100; ++i) applyMiss(landmark, 0.0, kSwitchProb);
  EXPECT_EQ(landmark.log_odds, 0.0);
}

}  // namespace
}  // namespace semantic_mht_slam
