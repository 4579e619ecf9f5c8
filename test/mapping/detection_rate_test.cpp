#include "semantic_mht_slam/mapping/detection_rate.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

TEST(DetectionRateTest, BeginsWithTheCurveOfTheConfigurationAndEndsAtTheLargestRange) {
  const DetectionConfig config;
  const DetectionRate rate(config, 2);
  EXPECT_NEAR(rate.prob(0, {1.0, 0.0, 0.0}), config.detection_prob, 1e-4);
  EXPECT_NEAR(rate.prob(1, {0.0, config.half_range_m, 0.0}), 0.5 * config.detection_prob, 1e-9);
  EXPECT_EQ(rate.prob(1, {config.max_range_m + 0.1, 0.0, 0.0}), 0.0);
}

TEST(DetectionRateTest, LearnsWhatWasSeenOfAClassByRangeAndBearing) {
  DetectionRate rate({}, 2);
  Rng rng(1);
  for (int i = 0; i < 20000; ++i) {
    rate.add(0, {15.0, 0.0, 0.0}, rng.bernoulli(0.9));   // ahead
    rate.add(0, {-15.0, 0.0, 0.0}, false);               // behind, out of the camera's view
    rate.add(1, {15.0, 0.0, 0.0}, rng.bernoulli(0.25));  // another class
  }
  EXPECT_NEAR(rate.prob(0, {15.0, 1.0, 0.0}), 0.9, 0.02);
  EXPECT_LT(rate.prob(0, {-15.0, 0.0, 0.0}), 0.01);
  EXPECT_NEAR(rate.prob(1, {15.0, -1.0, 0.0}), 0.25, 0.02);
  EXPECT_NEAR(rate.prob(0, {5.0, 0.0, 0.0}), 0.6, 0.01);  // nothing learned there
}

}  // namespace
}  // namespace semantic_mht_slam
