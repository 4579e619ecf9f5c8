#include "semantic_mht_slam/slam/standstill.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

int lookedAt(int frames, double step_m, double turn_rad) {
  Standstill standstill;
  int count = 0;
  for (int i = 0; i < frames; ++i) {
    count += standstill.add({expRotation({0.0, 0.0, turn_rad * i}), {step_m * i, 0.0, 0.0}}) ? 0 : 1;
  }
  return count;
}

TEST(StandstillTest, HoursAtOnePlaceAreSomeFrames) {
  EXPECT_EQ(lookedAt(100000, 0.0, 0.0), 300);
}

TEST(StandstillTest, NothingIsLeftOutOfADrive) {
  EXPECT_EQ(lookedAt(2000, 0.01, 0.0), 2000) << "a centimetre a frame";
  EXPECT_EQ(lookedAt(2000, 0.0, 0.001), 2000) << "turning on the spot";
}

TEST(StandstillTest, DrivingOnIsLookedAtAgain) {
  Standstill standstill;
  for (int i = 0; i < 1000; ++i) standstill.add(Pose::identity());
  EXPECT_TRUE(standstill.add(Pose::identity()));
  EXPECT_FALSE(standstill.add({Eigen::Quaterniond::Identity(), {0.2, 0.0, 0.0}}));
}

TEST(StandstillTest, APoseSaysNothingNewAfterManyFramesFromThere) {
  Standstill standstill;
  const Pose further{Eigen::Quaterniond::Identity(), {0.2, 0.0, 0.0}};
  for (int i = 0; i < 299; ++i) standstill.add(Pose::identity());
  EXPECT_FALSE(standstill.holds(Pose::identity()));
  standstill.add(Pose::identity());
  EXPECT_TRUE(standstill.holds(Pose::identity()));
  EXPECT_FALSE(standstill.holds(further));
  standstill.add(further);
  EXPECT_FALSE(standstill.holds(further));
}

TEST(StandstillTest, JitterIsNoMotion) {
  Rng rng(1);
  Standstill standstill;
  int count = 0;
  for (int i = 0; i < 5000; ++i) {
    count += standstill.add({Eigen::Quaterniond::Identity(), {rng.normal(0.0, 0.005), 0.0, 0.0}}) ? 0 : 1;
  }
  EXPECT_EQ(count, 300);
}

}  // namespace
}  // namespace semantic_mht_slam
