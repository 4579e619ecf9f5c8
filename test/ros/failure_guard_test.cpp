#include "semantic_mht_slam/ros/failure_guard.h"

#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

void fail() {
  throw std::logic_error("no inverse");
}

TEST(FailureGuardTest, FailuresAreCountedAndNamedAndThreeInARowLast) {
  FailureGuard guard;
  EXPECT_TRUE(guard.run("odometry", [] {}));
  EXPECT_FALSE(guard.run("odometry", fail));
  EXPECT_FALSE(guard.run("objects", fail));
  EXPECT_EQ(guard.status().newest, "objects: no inverse");
  EXPECT_FALSE(guard.status().isLasting());
  EXPECT_TRUE(guard.run("odometry", [] {}));
  EXPECT_FALSE(guard.run("objects", fail));
  EXPECT_FALSE(guard.run("objects", fail));
  EXPECT_FALSE(guard.status().isLasting()) << "one that worked ended the row";
  EXPECT_FALSE(guard.run("objects", [] { throw 7; }));
  EXPECT_TRUE(guard.status().isLasting());
  EXPECT_EQ(guard.status().count, 5U);
  guard.forgetRow();
  EXPECT_FALSE(guard.status().isLasting());
  EXPECT_EQ(guard.status().count, 5U);
}

}  // namespace
}  // namespace semantic_mht_slam
