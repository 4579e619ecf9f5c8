#include "semantic_mht_slam/map/landmark_corrections.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

RemovedLandmark removed(std::vector<LandmarkId> names, LandmarkId newest_name) {
  RemovedLandmark landmark;
  landmark.names = std::move(names);
  landmark.newest_name = newest_name;
  landmark.submap = SubmapId(0);
  landmark.radius_m = 1.0;
  return landmark;
}

TEST(LandmarkCorrectionsTest, ARemovedNameTakesLaterOnesAlongButNoneThatWasAnotherLandmark) {
  LandmarkCorrections corrections;
  corrections.remove(removed({3, 8}, 20));
  EXPECT_TRUE(corrections.isRemoved({3, 8}));
  EXPECT_TRUE(corrections.isRemoved({3, 8, 25})) << "seen again under a later name";
  EXPECT_FALSE(corrections.isRemoved({3, 5, 8})) << "5 stood there and was kept";
  EXPECT_FALSE(corrections.isRemoved({25}));
  corrections.remove(removed({5}, 30));
  EXPECT_TRUE(corrections.isRemoved({3, 5, 8})) << "both were removed";
  EXPECT_TRUE(corrections.bringBack({5}));
  EXPECT_FALSE(corrections.bringBack({5}));
  EXPECT_FALSE(corrections.isRemoved({5}));
  EXPECT_TRUE(corrections.isRemoved({8}));
}

TEST(LandmarkCorrectionsTest, CorrectionsOutliveTheProgram) {
  LandmarkCorrections corrections;
  corrections.remove(removed({3, 8}, 20));
  StateArchive writing;
  writing(corrections);
  const std::string reading_bytes = writing.written();
  StateArchive reading(reading_bytes);
  LandmarkCorrections read;
  reading(read);
  reading.requireEnd();
  EXPECT_TRUE(read.isRemoved({8}));
  EXPECT_EQ(read.removed()[0].radius_m, 1.0);
}

TEST(LandmarkCorrectionsTest, WhatIsNoCorrectionIsRefused) {
  for (const RemovedLandmark& bad : {removed({}, 20), removed({8, 3}, 20), removed({3, 8}, 5)}) {
    LandmarkCorrections corrections;
    corrections.remove(bad);
    StateArchive writing;
    writing(corrections);
    const std::string reading_bytes = writing.written();
    StateArchive reading(reading_bytes);
    LandmarkCorrections read;
    EXPECT_THROW(reading(read), InputError);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
