#include "semantic_mht_slam/mapping/clutter_model.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

constexpr double kVolume_m3 = 30000.0;
constexpr double kMaxRange_m = 50.0;

ClutterModel makeModel(const ClutterConfig& config = {}, double birth_prob = 0.3) {
  return {config, 3, 1.5, kVolume_m3, kMaxRange_m, birth_prob};
}

TEST(ClutterModelTest, BeginsWithWhatIsConfigured) {
  const ClutterModel model = makeModel();
  EXPECT_NEAR(std::exp(model.logDensity(0, {10.0, 0.0, 0.0})), 0.5 / kVolume_m3, 1e-9);
  EXPECT_NEAR(std::exp(model.logDensity(2, {-45.0, 5.0, 0.0})), 0.5 / kVolume_m3, 1e-9);
  EXPECT_NEAR(model.birthProb(1, {10.0, 0.0, 0.0}), 0.3, 1e-9);
}

TEST(ClutterModelTest, LearnsTheDensityOfAClassThatIsSpreadOverTheDisc) {
  ClutterModel model = makeModel();
  Rng rng(1);
  const int frames = 2000;
  model.addFrames(frames);
  for (int frame = 0; frame < frames; ++frame) {
    for (std::uint64_t n = rng.poisson(4.0); n > 0; --n) {
      const double range_m = kMaxRange_m * std::sqrt(rng.uniform());
      const double bearing = rng.uniform(-M_PI, M_PI);
      model.add(1, {range_m * std::cos(bearing), range_m * std::sin(bearing), 0.0}, 1.0, 0.0);
    }
  }
  for (const double range_m : {5.0, 15.0, 25.0, 35.0, 45.0}) {
    EXPECT_NEAR(std::exp(model.logDensity(1, {range_m, 0.0, 0.0})) * kVolume_m3, 4.0, 0.8) << range_m;
    EXPECT_NEAR(std::exp(model.logDensity(1, {0.0, range_m, 0.0})) * kVolume_m3, 4.0, 0.8) << range_m;
  }
  EXPECT_NEAR(std::exp(model.logDensity(0, {25.0, 0.0, 0.0})) * kVolume_m3, 0.5, 1e-9) << "never rarer than configured";
}

TEST(ClutterModelTest, LearnsWhereObjectsAppearFirst) {
  for (const double configured : {0.3, 0.95}) {
    ClutterModel model = makeModel({}, configured);
    model.addFrames(100);
    for (int i = 0; i < 100; ++i) {
      model.add(0, {45.0, 0.0, 0.0}, 0.1, 0.9);
      model.add(0, {5.0, 0.0, 0.0}, 1.0, 0.0);
    }
    EXPECT_NEAR(model.birthProb(0, {45.0, 1.0, 0.0}), std::min(configured, 0.9), 0.02) << "never likelier";
    EXPECT_LT(model.birthProb(0, {5.0, 1.0, 0.0}), 0.02);
  }
}

TEST(ClutterModelTest, LearnsNothingIfItMayNot) {
  ClutterModel model = makeModel({false, 2.0});
  model.addFrames(100);
  model.add(0, {5.0, 0.0, 0.0}, 1.0, 0.0);
  EXPECT_NEAR(std::exp(model.logDensity(0, {5.0, 0.0, 0.0})), 0.5 / kVolume_m3, 1e-12);
  EXPECT_NEAR(model.birthProb(0, {5.0, 0.0, 0.0}), 0.3, 1e-12);
}

}  // namespace
}  // namespace semantic_mht_slam
