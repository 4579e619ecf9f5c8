#include "semantic_mht_slam/bags/time_jump_guard.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr Stamp kSecond = 1000000000;

nav_msgs::Odometry at(Stamp stamp) {
  nav_msgs::Odometry message;
  message.header.stamp.fromNSec(static_cast<std::uint64_t>(stamp));
  return message;
}

TEST(TimeJumpGuardTest, OneWrongStampIsNotConfirmed) {
  for (const Stamp wrong : {1 * kSecond, 102 * kSecond, 105 * kSecond, 159 * kSecond, 4000 * kSecond}) {
    TimeJumpGuard guard(kSecond);
    ASSERT_TRUE(guard.isUnconfirmed(wrong, 100 * kSecond));
    guard.hold(at(wrong));
    EXPECT_FALSE(guard.isUnconfirmed(100 * kSecond + kSecond / 2, 100 * kSecond));
    EXPECT_FALSE(guard.takeConfirmed(100 * kSecond + kSecond / 2, 100 * kSecond));
    EXPECT_FALSE(guard.isHolding());
  }
}

TEST(TimeJumpGuardTest, ASecondMessageNearItConfirmsTheJump) {
  TimeJumpGuard guard(kSecond);
  guard.hold(at(kSecond));
  const auto held = guard.takeConfirmed(2 * kSecond, 100 * kSecond);
  ASSERT_TRUE(held);
  EXPECT_EQ(held->header.stamp.toSec(), 1.0);
}

TEST(TimeJumpGuardTest, SmallStepsAreNoJumps) {
  TimeJumpGuard guard(kSecond);
  EXPECT_FALSE(guard.isUnconfirmed(99 * kSecond + 500000000, 100 * kSecond));
  EXPECT_FALSE(guard.isUnconfirmed(101 * kSecond, 100 * kSecond));
  EXPECT_FALSE(guard.isUnconfirmed(kSecond, std::nullopt));
  guard.noteStep(100 * kSecond, 97 * kSecond);
  EXPECT_FALSE(guard.isUnconfirmed(130 * kSecond, 100 * kSecond)) << "ten times the usual step";
  EXPECT_TRUE(guard.isUnconfirmed(131 * kSecond, 100 * kSecond));
}

}  // namespace
}  // namespace semantic_mht_slam
