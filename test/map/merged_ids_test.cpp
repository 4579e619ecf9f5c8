#include "semantic_mht_slam/map/merged_ids.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

TEST(MergedIdsTest, AnIdFollowsItsSurvivorsInWhateverOrderTheyWereMerged) {
  MergedIds ids;
  EXPECT_TRUE(ids.merge(3, 2));
  EXPECT_TRUE(ids.merge(2, 1));
  EXPECT_TRUE(ids.merge(4, 3));
  for (const LandmarkId id : {1, 2, 3, 4}) EXPECT_EQ(ids.resolve(id), 1);
  EXPECT_EQ(ids.resolve(5), 5) << "never merged";
}

TEST(MergedIdsTest, WhatIsOneAlreadyIsNotMergedAgain) {
  MergedIds ids;
  ids.merge(3, 2);
  EXPECT_FALSE(ids.merge(2, 3)) << "would be a circle";
  EXPECT_FALSE(ids.merge(7, 7));
  EXPECT_EQ(ids.resolve(3), 2);
}

TEST(MergedIdsTest, ComesBackFromItsBytesAndACircleIsRefused) {
  MergedIds ids;
  ids.merge(3, 2);
  StateArchive written;
  written(ids);
  MergedIds read;
  StateArchive reading(written.written());
  reading(read);
  EXPECT_EQ(read.survivors(), ids.survivors());

  std::map<LandmarkId, LandmarkId> circle = {{1, 2}, {2, 1}};
  StateArchive bad;
  bad(circle);
  MergedIds refused;
  StateArchive bad_reading(bad.written());
  EXPECT_THROW(bad_reading(refused), InputError);
}

}  // namespace
}  // namespace semantic_mht_slam
