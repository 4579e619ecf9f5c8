#include <gtest/gtest.h>

#include "semantic_mht_slam/slam/slam.h"

#include "support/room_drive.h"

namespace semantic_mht_slam {
namespace {

class RoomTest : public testing::TestWithParam<int> {
 protected:
  RoomTest() : drive_(static_cast<std::uint64_t>(GetParam())), slam_(defaultsOf(Method::kDpmhm), makeRoomClasses()) {
    drive_.feed(slam_, 2);
    slam_.beginSession();
    drive_.beginSession();
  }

  RoomDrive drive_;
  Slam slam_;
};

TEST_P(RoomTest, ARobotThatSeesFewObjectsAtATimeFindsItselfInItsOwnMap) {
  slam_.localize();
  const std::size_t landmarks = landmarksOf(slam_).size();
  drive_.feed(slam_, 2);
  EXPECT_LT(drive_.largestErrorFrom(10.0), 0.5);
  EXPECT_EQ(landmarksOf(slam_).size(), landmarks);
}

TEST_P(RoomTest, WhatItSeesOfItsOwnMapIsNotMappedTwice) {
  drive_.feed(slam_, 2);
  EXPECT_FALSE(isLocalizing(slam_.mode()));
  EXPECT_LT(drive_.largestErrorFrom(10.0), 0.5);
  EXPECT_LE(landmarksOf(slam_).size(), drive_.objects() + 2);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RoomTest, testing::Values(1, 2, 3));

}  // namespace
}  // namespace semantic_mht_slam
