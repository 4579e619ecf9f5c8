#include "semantic_mht_slam/map/map.h"

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

MixtureLandmark makeLandmark(LandmarkId id, double x, double existence, int observations = 1) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position = {{x, 0.0, 0.0}, Eigen::Vector3d(0.04, 0.01, 0.09).asDiagonal()};
  landmark.components = {{1.0, landmark.position}};
  landmark.class_probs = ClassProbs::Constant(1, 1.0);
  landmark.existence_prob = existence;
  landmark.observations = observations;
  return landmark;
}

class MapTest : public testing::Test {
 protected:
  /// A submap with one keyframe and, for each landmark, one frame that shows it.
  void add(std::vector<MixtureLandmark> landmarks, std::vector<SameLandmark> duplicates = {}) {
    auto submap = std::make_shared<Submap>();
    submap->id = map_.submaps().nextId();
    for (MixtureLandmark& landmark : landmarks) {
      landmark.first_submap = landmark.last_submap = submap->id;
      submap->associations.push_back({next_frame_++, 0, landmark.id});
    }
    submap->landmarks = std::move(landmarks);
    submap->duplicates = std::move(duplicates);
    Keyframe keyframe;
    keyframe.driven_m = 100.0 * static_cast<double>(submap->id.index());
    map_.add(std::move(submap), {keyframe});
    poses_.push_back({Eigen::Quaterniond::Identity(), {keyframe.driven_m, 0.0, 0.0}});
    map_.apply({poses_, {}, ""});
  }

  /// A verified closure between the newest keyframe and the first that says so.
  ClosureId close(const std::vector<SameLandmark>& pairs) {
    LoopClosureRecord closure;
    closure.query_keyframe = KeyframeId(map_.keyframes().size() - 1);
    closure.match_keyframe = KeyframeId(0);
    closure.is_verified = true;
    closure.pairs = pairs;
    return map_.add(closure);
  }

  static std::vector<MixtureLandmark> landmarksOf(const Map& map) {
    std::vector<MixtureLandmark> landmarks;
    map.forEachLandmark([&](SubmapId, const MixtureLandmark& landmark) { landmarks.push_back(landmark); });
    return landmarks;
  }

  static std::vector<LandmarkId> idsOf(const Map& map, std::size_t submap) {
    std::vector<LandmarkId> ids;
    map.forEachLandmarkOf(SubmapId(submap), [&](LandmarkId, const MixtureLandmark& l) { ids.push_back(l.id); });
    return ids;
  }

  Map map_{0.5};
  std::vector<Pose> poses_;
  std::size_t next_frame_ = 0;
};

TEST_F(MapTest, TheLastSubmapThatSawALandmarkHasIt) {
  add({makeLandmark(1, 40.0, 0.9), makeLandmark(2, -7.0, 0.9)});
  add({makeLandmark(1, 5.0, 0.9, 4), makeLandmark(6, 3.0, 0.2)});
  EXPECT_EQ(idsOf(map_, 0), std::vector<LandmarkId>{2});
  EXPECT_EQ(idsOf(map_, 1), std::vector<LandmarkId>{1}) << "6 is not part of the map";
  EXPECT_EQ(map_.reach_m(SubmapId(0)), 40.0);
  EXPECT_EQ(landmarksOf(map_)[0].position.mean_m.x(), 5.0);
  EXPECT_EQ(landmarksOf(map_)[0].observations, 4) << "the newest submap counts those before";
}

TEST_F(MapTest, AClosureThatIsRefusedAndOneThatIsTakenBackLeaveNothingMerged) {
  add({makeLandmark(1, 0.0, 0.9, 3)});
  add({makeLandmark(5, 0.2, 0.7, 4)});
  const ClosureId closure = close({{5, 1}});
  EXPECT_EQ(landmarksOf(map_).size(), 2U) << "not decided";
  map_.apply({{}, {{closure, false}}, ""});
  EXPECT_EQ(landmarksOf(map_).size(), 2U);
  EXPECT_EQ(map_.closures()[closure].reason, "refused by the pose graph");
  map_.apply({{}, {{closure, true}}, ""});
  ASSERT_EQ(landmarksOf(map_).size(), 1U);
  const MixtureLandmark one = landmarksOf(map_)[0];
  EXPECT_EQ(one.id, 1U);
  EXPECT_EQ(one.merged_ids, std::vector<LandmarkId>{5});
  EXPECT_EQ(one.observations, 7);
  EXPECT_EQ(one.existence_prob, 0.9);
  EXPECT_EQ(one.position.mean_m.x(), 0.2);
  EXPECT_EQ(map_.closedAt_m(), 100.0);
  for (const DetectionAssociation& association : map_.associations()) EXPECT_EQ(association.landmark, 1U);
  map_.apply({{}, {{closure, false}}, ""});
  ASSERT_EQ(landmarksOf(map_).size(), 2U);
  EXPECT_EQ(landmarksOf(map_)[0].observations, 3);
  EXPECT_EQ(landmarksOf(map_)[1].observations, 4);
  EXPECT_EQ(idsOf(map_, 0), std::vector<LandmarkId>{1});
  EXPECT_EQ(idsOf(map_, 1), std::vector<LandmarkId>{5});
  EXPECT_EQ(map_.associations()[1].landmark, 5U);
  EXPECT_EQ(map_.closedAt_m(), 0.0);
  EXPECT_EQ(map_.identity().ledger().size(), 2U);
}

TEST_F(MapTest, ASubmapThatStillUsesALaterNameMakesNoSecondLandmark) {
  add({makeLandmark(1, 0.0, 0.9)});
  add({makeLandmark(5, 0.2, 0.7)});
  map_.apply({{}, {{close({{5, 1}}), true}}, ""});
  add({makeLandmark(5, 0.3, 0.8)});
  ASSERT_EQ(landmarksOf(map_).size(), 1U);
  EXPECT_EQ(landmarksOf(map_)[0].id, 1U);
  EXPECT_EQ(idsOf(map_, 2), std::vector<LandmarkId>{1});
  LandmarkId name = kNoLandmark;
  map_.forEachLandmarkOf(SubmapId(2), [&](LandmarkId n, const MixtureLandmark&) { name = n; });
  EXPECT_EQ(name, 5U) << "as the submap calls it";
}

TEST_F(MapTest, DuplicatesOfASubmapAreOne) {
  add({makeLandmark(1, 0.0, 0.9)});
  add({makeLandmark(2, 0.1, 0.9)}, {{1, 2}});
  ASSERT_EQ(landmarksOf(map_).size(), 1U);
  EXPECT_EQ(landmarksOf(map_)[0].id, 1U);
  EXPECT_EQ(map_.identity().ledger()[0].closure, ClosureId());
}

TEST_F(MapTest, DetectionsOfUnlikelyLandmarksAreFalsePositives) {
  add({makeLandmark(1, 0.0, 0.2), makeLandmark(2, 5.0, 0.8)});
  EXPECT_EQ(map_.associations()[0].landmark, kNoLandmark);
  EXPECT_EQ(map_.associations()[1].landmark, 2U);
  EXPECT_EQ(landmarksOf(map_).size(), 1U);
}

TEST_F(MapTest, WrittenAndReadItIsTheSame) {
  add({makeLandmark(1, 4.0, 0.9), makeLandmark(2, -7.0, 0.9)});
  add({makeLandmark(3, 1.0, 0.7)});
  const ClosureId closure = close({{3, 2}});
  map_.apply({{}, {{closure, true}}, ""});
  map_.apply({{}, {{closure, false}}, ""});
  add({makeLandmark(7, 1.0, 0.7)});
  map_.apply({{}, {{close({{7, 1}}), true}}, ""});
  StateArchive submaps;
  StateArchive rest;
  map_.transferSubmaps(submaps);
  map_.transferKeyframes(rest, 1, 0.1);
  Map again(0.5);
  const std::string reading_bytes = submaps.written();
  StateArchive reading(reading_bytes);
  again.transferSubmaps(reading);
  const std::string reading_rest_bytes = rest.written();
  StateArchive reading_rest(reading_rest_bytes);
  again.transferKeyframes(reading_rest, 1, 0.1);
  reading_rest.requireEnd();
  ASSERT_EQ(landmarksOf(again).size(), landmarksOf(map_).size());
  for (std::size_t submap = 0; submap < 3; ++submap) EXPECT_EQ(idsOf(again, submap), idsOf(map_, submap));
  EXPECT_EQ(again.identity().ledger().size(), map_.identity().ledger().size());
  EXPECT_EQ(again.takeChanges(), map_.takeChanges());
  EXPECT_FALSE(again.closures()[closure].is_accepted);
  EXPECT_EQ(again.closures()[closure].pairs.size(), 1U) << "it may hold again";
  EXPECT_EQ(again.closedAt_m(), 200.0);
}

TEST_F(MapTest, SubmapsOutOfOrderOrWithoutKeyframesAreRefused) {
  auto submap = std::make_shared<Submap>();
  submap->id = SubmapId(1);
  EXPECT_THROW(map_.add(submap, {Keyframe{}}), std::invalid_argument);
  submap->id = SubmapId(0);
  EXPECT_THROW(map_.add(submap, {}), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
