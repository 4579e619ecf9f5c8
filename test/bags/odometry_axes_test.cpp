#include "semantic_mht_slam/bags/odometry_axes.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"

namespace semantic_mht_slam {
namespace {

/// Unit vectors in the axes that are converted from.
struct Directions {
  OdometryAxes axes;
  Eigen::Vector3d forward, left, up;
};

const Directions kDirections[] = {
    {OdometryAxes::kRos, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    {OdometryAxes::kLoam, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}},
    {OdometryAxes::kOptical, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}},
};

TEST(OdometryAxesTest, ForwardLeftAndUpBecomeXYAndZ) {
  for (const Directions& from : kDirections) {
    const Pose pose{Eigen::Quaterniond::Identity(), 3.0 * from.forward + 2.0 * from.left + 1.0 * from.up};
    EXPECT_NEAR((toRosAxes(pose, from.axes).translation_m - Eigen::Vector3d(3, 2, 1)).norm(), 0.0, 1e-12);
  }
}

TEST(OdometryAxesTest, TurnToTheLeftIsAPositiveTurnAboutZ) {
  for (const Directions& from : kDirections) {
    const Pose pose{expRotation(0.3 * from.up), Eigen::Vector3d::Zero()};
    EXPECT_NEAR((logRotation(toRosAxes(pose, from.axes).rotation) - Eigen::Vector3d(0, 0, 0.3)).norm(), 0.0, 1e-12);
  }
}

TEST(OdometryAxesTest, UnknownNamesAreRefused) {
  EXPECT_EQ(odometryAxesOf("loam"), OdometryAxes::kLoam);
  EXPECT_THROW(odometryAxesOf("enu"), InputError);
}

}  // namespace
}  // namespace semantic_mht_slam
