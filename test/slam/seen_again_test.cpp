#include "semantic_mht_slam/slam/seen_again.h"

#include <memory>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

constexpr double kNear_m = 0.5;
enum Class { kPole, kVehicle };

ClassTable makeDenseClasses() {
  std::vector<ClassInfo> classes(2);
  classes[kPole].name = "pole";
  classes[kVehicle].id = 2;
  classes[kVehicle].name = "vehicle";
  classes[kVehicle].is_static = false;
  return ClassTable(classes, "test");
}

MixtureLandmark landmark(LandmarkId id, const Eigen::Vector3d& position_m, ClassIndex class_index = kPole) {
  MixtureLandmark result;
  result.id = id;
  result.position = {position_m, 0.0025 * Eigen::Matrix3d::Identity()};
  result.components = {{1.0, result.position}};
  result.class_probs = ClassProbs::Zero(2);
  result.class_probs[class_index] = 1.0;
  result.existence_prob = 1.0;
  return result;
}

/// A pass of one submap and one keyframe at the origin of the map.
void addPass(Map& map, std::vector<MixtureLandmark> landmarks) {
  auto submap = std::make_shared<Submap>();
  submap->id = map.submaps().nextId();
  for (MixtureLandmark& landmark : landmarks) landmark.first_submap = landmark.last_submap = submap->id;
  submap->landmarks = std::move(landmarks);
  map.add(submap, {Keyframe{}});
  map.apply({std::vector<Pose>(map.keyframes().size(), Pose::identity()), {}, ""});
}

/// Says that the second pass is where the first was.
ClosureId tie(Map& map, bool holds = true) {
  LoopClosureRecord closure;
  closure.query_keyframe = KeyframeId(1);
  closure.match_keyframe = KeyframeId(0);
  closure.is_verified = true;
  closure.cov = 1e-4 * PoseCov::Identity();
  const ClosureId id = map.add(closure);
  map.apply({{}, {{id, holds}}, ""});
  return id;
}

std::vector<SameLandmark> seenAgain(const Map& map) {
  const ClassTable classes = makeDenseClasses();
  const MapGraph graph({}, classes);
  return landmarksSeenAgain(map, graph, classes, map.closures()[ClosureId(0)], 1, kNear_m);
}

TEST(SeenAgainTest, WhatStandsWhereAnEarlierPassSawTheSameIsTheSame) {
  Map map(0.5);
  addPass(map, {landmark(1, {5.0, 1.0, 0.0}), landmark(2, {9.0, 1.0, 0.0}), landmark(3, {13.0, 1.0, 0.0})});
  addPass(map, {landmark(11, {5.0, 1.1, 0.0}), landmark(12, {9.0, 1.4, 0.0}), landmark(13, {17.0, 1.0, 0.0})});
  const ClosureId id = tie(map);
  const auto pairs = seenAgain(map);
  ASSERT_EQ(pairs.size(), 1U) << "one is too far for its noise, one is new";
  EXPECT_EQ(pairs[0], SameLandmark(11, 1));
  map.addPairs(id, pairs);
  EXPECT_EQ(map.identity().landmarkOf(11), 1U);
  EXPECT_TRUE(seenAgain(map).empty());
}

TEST(SeenAgainTest, TheyAreTwoAgainIfTheClosureFalls) {
  Map map(0.5);
  addPass(map, {landmark(1, {5.0, 1.0, 0.0})});
  addPass(map, {landmark(11, {5.0, 1.0, 0.0})});
  const ClosureId id = tie(map);
  map.addPairs(id, seenAgain(map));
  map.apply({{}, {{id, false}}, ""});
  EXPECT_EQ(map.identity().landmarkOf(11), 11U);
}

TEST(SeenAgainTest, OneOfTwoThatItMayBeIsNotGuessed) {
  Map map(0.5);
  addPass(map, {landmark(1, {5.0, 1.0, 0.0}), landmark(2, {5.0, 1.15, 0.0})});
  addPass(map, {landmark(11, {5.0, 1.05, 0.0})});
  tie(map);
  EXPECT_TRUE(seenAgain(map).empty());
}

TEST(SeenAgainTest, AnotherClassAndWhatMayHaveMovedAreOthers) {
  Map map(0.5);
  addPass(map, {landmark(1, {5.0, 1.0, 0.0}, kPole), landmark(2, {9.0, 1.0, 0.0}, kVehicle)});
  addPass(map, {landmark(11, {5.0, 1.0, 0.0}, kVehicle), landmark(12, {9.0, 1.0, 0.0}, kVehicle)});
  tie(map);
  EXPECT_TRUE(seenAgain(map).empty());
}

TEST(SeenAgainTest, WhatThePresentPassKnowsAndWhatItTakesForNewMayBeTheSame) {
  Map map(0.5);
  addPass(map, {landmark(1, {5.0, 1.0, 0.0}), landmark(2, {9.0, 1.0, 0.0})});
  addPass(map, {landmark(11, {5.0, 1.1, 0.0}), landmark(21, {5.0, 1.0, 0.0})});
  map.addPairs(tie(map), {{21, 1}});
  const auto pairs = seenAgain(map);
  ASSERT_EQ(pairs.size(), 1U);
  EXPECT_EQ(pairs[0], SameLandmark(11, 1));
}

TEST(SeenAgainTest, OnlyAClosureThatHoldsTies) {
  Map map(0.5);
  addPass(map, {landmark(1, {5.0, 1.0, 0.0})});
  EXPECT_TRUE(newestTie(map).isNone());
  addPass(map, {landmark(11, {5.0, 1.0, 0.0})});
  EXPECT_TRUE(newestTie(map).isNone());
  const ClosureId id = tie(map);
  EXPECT_EQ(newestTie(map), id);
  map.apply({{}, {{id, false}}, ""});
  EXPECT_TRUE(newestTie(map).isNone());
}

}  // namespace
}  // namespace semantic_mht_slam
