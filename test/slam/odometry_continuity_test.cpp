#include "semantic_mht_slam/slam/odometry_continuity.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

StampedPose at(double time_s, double x_m, double yaw_rad = 0.0) {
  return {stampFromSeconds(time_s), {expRotation({0.0, 0.0, yaw_rad}), {x_m, 0.0, 0.0}}};
}

/// 10 m/s for 5 s, ten times a second.
OdometryContinuity driven(double step_m = 1.0) {
  OdometryContinuity continuity;
  for (int i = 0; i <= 50; ++i) continuity.add(at(0.1 * i, step_m * i));
  return continuity;
}

TEST(OdometryContinuityTest, DrivingOnGoesOn) {
  EXPECT_TRUE(OdometryContinuity().goesOn(at(0.0, 1000.0)));
  EXPECT_TRUE(driven().goesOn(at(5.1, 51.0)));
  EXPECT_TRUE(driven().goesOn(at(5.1, 50.0))) << "a stop";
  EXPECT_TRUE(driven().goesOn(at(15.0, 150.0))) << "after a pause";
}

TEST(OdometryContinuityTest, ASlowRobotMayGetFast) {
  EXPECT_TRUE(driven(0.0).goesOn(at(5.1, 0.6)));
  EXPECT_TRUE(driven(0.0).goesOn(at(7.0, 10.0)));
}

TEST(OdometryContinuityTest, AJumpIsNoMotion) {
  EXPECT_FALSE(driven().goesOn(at(5.1, 60.0)));
  EXPECT_FALSE(driven(0.05).goesOn(at(5.1, 5.5))) << "for a slow robot a short one, too";
  EXPECT_FALSE(driven().goesOn(at(5.1, 51.0, 2.5))) << "nor a turn at once";
  EXPECT_FALSE(driven().goesOn(at(4.0, 50.0))) << "nor what was before";
}

TEST(OdometryContinuityTest, SetToZeroIsABeginningWhateverThePause) {
  EXPECT_FALSE(driven().goesOn(at(5.5, 0.0)));
  EXPECT_FALSE(driven().goesOn(at(25.0, 0.0)));
  EXPECT_TRUE(driven().goesOn(at(25.0, 7.0))) << "may have come back";
}

TEST(OdometryContinuityTest, DrivingThroughTheOriginGoesOn) {
  OdometryContinuity continuity;
  for (int i = 0; i < 50; ++i) continuity.add(at(0.1 * i, 50.0 - i));
  EXPECT_TRUE(continuity.goesOn(at(5.0, 0.0)));
}

TEST(OdometryContinuityTest, TheFirstStepsTellHowFastItIs) {
  OdometryContinuity continuity;
  continuity.add(at(0.0, 0.0));
  EXPECT_TRUE(continuity.goesOn(at(0.1, 2.0)));
  EXPECT_FALSE(continuity.goesOn(at(0.1, 200.0)));
}

TEST(OdometryContinuityTest, AfterAJumpItBeginsAnew) {
  OdometryContinuity continuity = driven();
  continuity.add(at(5.1, -300.0));
  EXPECT_TRUE(continuity.goesOn(at(5.2, -299.0)));
}

TEST(OdometryContinuityTest, GoesOnFromAState) {
  OdometryContinuity continuity = driven();
  StateArchive writing;
  continuity.transfer(writing);
  OdometryContinuity restored;
  const std::string reading_bytes = writing.written();
  StateArchive reading(reading_bytes);
  restored.transfer(reading);
  EXPECT_FALSE(restored.goesOn(at(5.1, 60.0)));
  EXPECT_TRUE(restored.goesOn(at(5.1, 51.0)));
}

}  // namespace
}  // namespace semantic_mht_slam
