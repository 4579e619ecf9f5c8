#include "semantic_mht_slam/slam/revisit_search.h"

#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/random.h"

namespace semantic_mht_slam {
namespace {

ClassTable makeClasses() {
  std::vector<ClassInfo> classes(2);
  classes[0].id = 1;
  classes[0].name = "pole";
  classes[1].id = 2;
  classes[1].name = "trunk";
  return ClassTable(classes, "test");
}

/// A street along x with objects at random beside it, or the same object every 10 m.
std::vector<SceneObject> makeStreet(Rng& rng, bool is_regular) {
  std::vector<SceneObject> objects;
  for (int i = 0; i < 80; ++i) {
    SceneObject object;
    const double x = is_regular ? 10.0 * (i / 2) - 150.0 : rng.uniform(-150.0, 250.0);
    const double y = is_regular ? (i % 2 == 0 ? 8.0 : -8.0) : rng.uniform(-20.0, 20.0);
    object.position_m = {x, y, is_regular ? 1.0 : rng.uniform(0.0, 2.0)};
    object.cov_m2 = 0.01 * Eigen::Matrix3d::Identity();
    object.class_index = is_regular ? 0 : static_cast<ClassIndex>(rng.index(2));
    objects.push_back(object);
  }
  return objects;
}

/// Keyframes every 10 m that see what is within 40 m; landmark ids count from `first_id`.
void drive(Map& map, const std::vector<SceneObject>& world, double driven_m, const Pose& T_believed_true,
           LandmarkId first_id, Rng& rng) {
  std::vector<Keyframe> keyframes;
  GraphUpdate poses{{map.T_map_keyframes().begin(), map.T_map_keyframes().end()}, {}, ""};
  for (int k = 0; k < 8; ++k) {
    Keyframe keyframe;
    keyframe.driven_m = driven_m + 10.0 * k;
    const Pose T_true{Eigen::Quaterniond::Identity(), {10.0 * k, 0.0, 0.0}};
    for (std::size_t i = 0; i < world.size(); ++i) {
      SceneObject object = world[i];
      object.position_m = T_true.inverse() * object.position_m;
      if (object.position_m.norm() > 40.0) continue;
      for (int axis = 0; axis < 3; ++axis) object.position_m[axis] += rng.normal(0.0, 0.05);
      object.landmark = first_id + i;
      keyframe.scene.objects.push_back(object);
    }
    keyframes.push_back(keyframe);
    poses.T_map_keyframe.push_back(T_believed_true * T_true);
  }
  Submap submap;
  submap.id = map.submaps().nextId();
  map.add(std::make_shared<const Submap>(submap), keyframes);
  map.apply(poses);
}

RegistrationPrior priorOf(const Map& map, std::size_t keyframe) {
  return {map.T_map_keyframe(KeyframeId(keyframe)), 3.5, 1.75, 0.025};
}

TEST(RevisitSearchTest, AnOffsetIsFoundWithItsLandmarkPairs) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Rng rng(seed);
    const auto world = makeStreet(rng, false);
    Map map(0.5);
    drive(map, world, 0.0, Pose::identity(), 1000, rng);
    drive(map, world, 500.0, {expRotation({0.01, -0.02, 0.03}), {2.5, -1.5, 0.4}}, 5000, rng);
    const auto records = findRevisits(map, KeyframeId(12), priorOf(map, 12), makeClasses(), {}, RevisitConfig{});
    ASSERT_EQ(records.size(), 1U) << "seed " << seed;
    EXPECT_TRUE(records[0].is_verified) << records[0].reason;
    EXPECT_EQ(records[0].match_keyframe, KeyframeId(4));
    EXPECT_LT(records[0].T_match_query.translation_m.norm(), 0.2) << "both passes were at the same place";
    EXPECT_LT(angularDistance(records[0].T_match_query.rotation, Eigen::Quaterniond::Identity()), 0.02);
    EXPECT_EQ(records[0].pairs.size(), map.keyframes()[KeyframeId(12)].scene.objects.size())
        << "all of them were seen before";
    for (const auto& [query, match] : records[0].pairs) EXPECT_EQ(query - 5000, match - 1000) << "seed " << seed;
  }
}

TEST(RevisitSearchTest, APlaceThatWasNotSeenBeforeIsNotAccepted) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    Map map(0.5);
    drive(map, makeStreet(rng, false), 0.0, Pose::identity(), 1000, rng);
    drive(map, makeStreet(rng, false), 500.0, Pose::identity(), 5000, rng);
    for (const auto& record : findRevisits(map, KeyframeId(12), priorOf(map, 12), makeClasses(), {}, RevisitConfig{})) {
      EXPECT_FALSE(record.is_verified) << "seed " << seed;
    }
  }
}

TEST(RevisitSearchTest, ARegularRowIsAmbiguous) {
  Rng rng(1);
  const auto world = makeStreet(rng, true);
  Map map(0.5);
  drive(map, world, 0.0, Pose::identity(), 1000, rng);
  drive(map, world, 500.0, {Eigen::Quaterniond::Identity(), {5.0, 0.0, 0.0}}, 5000, rng);
  const auto records = findRevisits(map, KeyframeId(12), priorOf(map, 12), makeClasses(), {}, RevisitConfig{});
  ASSERT_FALSE(records.empty());
  EXPECT_FALSE(records[0].is_verified);
}

TEST(RevisitSearchTest, WhatWasJustDrivenIsNoRevisit) {
  Rng rng(1);
  const auto world = makeStreet(rng, false);
  Map map(0.5);
  drive(map, world, 0.0, Pose::identity(), 1000, rng);
  EXPECT_TRUE(findRevisits(map, KeyframeId(7), priorOf(map, 7), makeClasses(), {}, RevisitConfig{}).empty());
}

TEST(RevisitSearchTest, AnEmptySceneHasNoRevisit) {
  Rng rng(1);
  Map map(0.5);
  drive(map, makeStreet(rng, false), 0.0, Pose::identity(), 1000, rng);
  drive(map, {}, 500.0, Pose::identity(), 5000, rng);
  EXPECT_TRUE(findRevisits(map, KeyframeId(12), priorOf(map, 12), makeClasses(), {}, RevisitConfig{}).empty());
}

}  // namespace
}  // namespace semantic_mht_slam
