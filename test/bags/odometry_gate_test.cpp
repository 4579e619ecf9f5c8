#include "semantic_mht_slam/bags/odometry_gate.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/bags/conversions.h"

namespace semantic_mht_slam {
namespace {

nav_msgs::Odometry messageAt(double time_s, const std::string& odom = "odom", const std::string& base = "base_link") {
  return toOdometry({stampFromSeconds(time_s), Pose::identity()}, odom, base);
}

std::vector<Stamp> stampsOf(const std::vector<double>& times_s) {
  std::vector<Stamp> stamps;
  for (const double time_s : times_s) stamps.push_back(stampFromSeconds(time_s));
  return stamps;
}

/// Sends messages of these stamps through a gate; the stamps of what came out, each used at once.
std::vector<Stamp> used(const std::vector<double>& times_s, RefusedInput& refused) {
  OdometryGate gate{NodeConfig()};
  std::vector<Stamp> result;
  for (const double time_s : times_s) {
    const auto latest = result.empty() ? std::nullopt : std::optional(result.back());
    for (const nav_msgs::Odometry& message : gate.pass(messageAt(time_s), latest, refused)) {
      result.push_back(toStamp(message.header.stamp));
    }
  }
  return result;
}

TEST(OdometryGateTest, FramesWithOrWithoutSlashPassAndOthersAreCountedAndNamed) {
  const OdometryGate gate{NodeConfig()};
  RefusedInput refused;
  EXPECT_TRUE(gate.isUsable(messageAt(1.0), refused));
  EXPECT_TRUE(gate.isUsable(messageAt(1.0, "/odom", "/base_link"), refused));
  EXPECT_EQ(refused.odometry_wrong_frames, 0U);
  EXPECT_FALSE(gate.isUsable(messageAt(1.0, "camera_init"), refused));
  EXPECT_FALSE(gate.isUsable(messageAt(1.0, "odom", "camera"), refused));
  EXPECT_EQ(refused.odometry_wrong_frames, 2U);
  EXPECT_EQ(refused.wrong_frames, "'odom' to 'camera'");
}

TEST(OdometryGateTest, StampsThatOneCannotComputeWithAreRefused) {
  const OdometryGate gate{NodeConfig()};
  RefusedInput refused;
  nav_msgs::Odometry message = messageAt(1.0);
  message.header.stamp = ros::Time(0, 0);
  EXPECT_FALSE(gate.isUsable(message, refused));
  message.header.stamp = ros::Time(4294967295U, 999999999U);
  EXPECT_FALSE(gate.isUsable(message, refused));
  EXPECT_EQ(refused.odometry_bad_stamps, 2U);
  message.header.stamp = ros::Time(4290000000U, 0U);
  EXPECT_TRUE(gate.isUsable(message, refused)) << "2105 is a year like others";
}

TEST(OdometryGateTest, OneStampFarFromTheOthersIsLeftOutAndCounted) {
  for (const double wrong_s : {3700.0, 159.0, 130.0, 105.0, 102.0, 2.0}) {
    RefusedInput refused;
    EXPECT_EQ(used({100.0, 100.1, wrong_s, 100.2, 100.3}, refused), stampsOf({100.0, 100.1, 100.2, 100.3}));
    EXPECT_EQ(refused.odometry_stamp_outliers, 1U) << wrong_s;
  }
}

TEST(OdometryGateTest, AJumpThatTheNextMessageConfirmsLosesNothing) {
  for (const double jump_s : {3700.0, 130.0, 102.0, 2.0}) {
    RefusedInput refused;
    EXPECT_EQ(used({100.0, 100.1, jump_s, jump_s + 0.1}, refused), stampsOf({100.0, 100.1, jump_s, jump_s + 0.1}));
    EXPECT_EQ(refused.odometry_stamp_outliers, 0U) << jump_s;
  }
}

}  // namespace
}  // namespace semantic_mht_slam
