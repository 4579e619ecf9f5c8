#include "semantic_mht_slam/mapping/earlier_map.h"

#include <map>

#include <gtest/gtest.h>

#include "semantic_mht_slam/map/merged_ids.h"

namespace semantic_mht_slam {
namespace {

MixtureLandmark withId(LandmarkId id) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.observations = 10;
  return landmark;
}

/// Landmark 1 is known from an earlier pass.
class JoinEarlierLandmarksTest : public ::testing::Test {
 protected:
  void join(const std::vector<MergedLandmark>& found) {
    joinEarlierLandmarks(
        found, [this](LandmarkId) -> const MixtureLandmark& { return known_; }, landmarks_, merged_);
  }

  /// What an id stands for after the submap.
  LandmarkId resolved(LandmarkId id) const {
    MergedIds ids;
    for (const auto& [merged, survivor] : merged_) EXPECT_TRUE(ids.merge(merged, survivor)) << "a circle";
    return ids.resolve(id);
  }

  MixtureLandmark known_ = withId(1);
  std::vector<MixtureLandmark> landmarks_ = {withId(7), withId(8)};
  std::vector<MergedLandmark> merged_;
};

TEST_F(JoinEarlierLandmarksTest, ALandmarkTakesTheEarlierIdAndItsHistory) {
  join({{8, 1}});
  ASSERT_EQ(landmarks_.size(), 2U);
  EXPECT_EQ(landmarks_[0].id, 1) << "sorted";
  EXPECT_EQ(landmarks_[0].observations, 20);
  EXPECT_EQ(landmarks_[1].id, 7);
  EXPECT_EQ(resolved(8), 1);
}

TEST_F(JoinEarlierLandmarksTest, AnEarlierLandmarkThatWasADuplicateOfItsSuccessorMakesNoCircle) {
  merged_ = {{9, 7}, {1, 7}};
  join({{7, 1}});
  EXPECT_EQ(resolved(7), 1);
  EXPECT_EQ(resolved(9), 1);
  EXPECT_EQ(resolved(1), 1);
}

TEST_F(JoinEarlierLandmarksTest, AnEarlierLandmarkThatWasADuplicateOfAnotherBelongsToTheMatchedOne) {
  merged_ = {{1, 8}};
  join({{7, 1}});
  EXPECT_EQ(resolved(7), 1);
  EXPECT_EQ(resolved(8), 8);
}

TEST_F(JoinEarlierLandmarksTest, NoIdIsThereTwice) {
  landmarks_ = {withId(1), withId(7), withId(8)};
  join({{7, 1}, {8, 1}});
  std::map<LandmarkId, int> count;
  for (const MixtureLandmark& landmark : landmarks_) ++count[landmark.id];
  EXPECT_EQ(count.size(), landmarks_.size());
  EXPECT_TRUE(merged_.empty());
}

}  // namespace
}  // namespace semantic_mht_slam
