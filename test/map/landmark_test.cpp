#include "semantic_mht_slam/map/landmark.h"

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

TEST(LandmarkTest, ListsByRisingIdAreSearchedById) {
  std::vector<MixtureLandmark> landmarks(3);
  for (std::size_t i = 0; i < landmarks.size(); ++i) landmarks[i].id = 10 * (i + 1);
  EXPECT_EQ(findLandmark(20, landmarks), &landmarks[1]);
  EXPECT_EQ(findLandmark(25, landmarks), nullptr);
  EXPECT_EQ(findLandmark(31, landmarks), nullptr);
  EXPECT_EQ(findLandmark(1, {}), nullptr);
  EXPECT_EQ(placeOf(25, landmarks) - landmarks.begin(), 2);
  EXPECT_EQ(placeOf(30, landmarks) - landmarks.begin(), 2);
  EXPECT_EQ(placeOf(31, landmarks) - landmarks.begin(), 3);
}

}  // namespace
}  // namespace semantic_mht_slam
