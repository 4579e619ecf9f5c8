#include "semantic_mht_slam/mapping/detector_range.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

Detections seenUpTo(double range_m, int count, Rng& rng) {
  Detections detections(static_cast<std::size_t>(count));
  for (Detection& detection : detections) detection.position_m = {range_m * std::sqrt(rng.uniform(0.0, 1.0)), 0.0, 0.0};
  return detections;
}

double factorOf(double range_m, int a_frame) {
  Rng rng(1);
  DetectorRange range;
  for (int i = 0; i < 100 && !range.add(seenUpTo(range_m, a_frame, rng)); ++i) {
  }
  return range.factor();
}

TEST(DetectorRangeTest, IsAPowerOfTwoOfTheReference) {
  EXPECT_EQ(factorOf(35.0, 10), 1.0);
  EXPECT_EQ(factorOf(30.0, 10), 1.0);
  EXPECT_EQ(factorOf(70.0, 10), 2.0);
  EXPECT_EQ(factorOf(4.5, 10), 0.125);
  EXPECT_EQ(factorOf(4.5, 2), 0.125) << "frames that show little are enough after some";
}

TEST(DetectorRangeTest, TellsWhenEnoughWasSeen) {
  Rng rng(2);
  DetectorRange many;
  EXPECT_FALSE(many.add(seenUpTo(30.0, 20, rng)));
  EXPECT_TRUE(many.add(seenUpTo(30.0, 20, rng)));
  DetectorRange few;
  for (int i = 0; i < 19; ++i) EXPECT_FALSE(few.add(seenUpTo(30.0, 1, rng)));
  for (int i = 0; i < 100; ++i) EXPECT_FALSE(few.add({})) << "frames without detections say nothing";
  EXPECT_TRUE(few.add(seenUpTo(30.0, 1, rng)));
}

TEST(DetectorRangeTest, NothingSeenChangesNothing) {
  EXPECT_EQ(DetectorRange().factor(), 1.0);
}

}  // namespace
}  // namespace semantic_mht_slam
