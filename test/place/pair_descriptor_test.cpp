#include "semantic_mht_slam/place/pair_descriptor.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "scene_test_util.h"

namespace semantic_mht_slam {
namespace {

const ClassTable kClasses = makeStreetClasses();

PairDescriptor descriptorOf(const Scene& scene) {
  return describePairs(scene, kClasses, 0.15, {});
}

/// The scene without noise from another pose.
Scene movedExactly(const Scene& scene, const Pose& T_scene_keyframe) {
  Scene result = scene;
  for (SceneObject& object : result.objects) object.position_m = T_scene_keyframe.inverse() * object.position_m;
  return result;
}

TEST(PairDescriptorTest, DoesNotChangeWithPoseOrDirectionOfTravelOrOrder) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const Scene scene = makeStreet(30, 0.05, rng);
    Scene other = movedExactly(scene, planarPose(rng.normal(), rng.normal(), M_PI + rng.normal()));
    std::reverse(other.objects.begin(), other.objects.end());
    EXPECT_LT((descriptorOf(scene) - descriptorOf(other)).norm(), 1e-4) << "seed " << seed;
  }
}

TEST(PairDescriptorTest, ObjectsBeyondAnyDistanceCountForNothing) {
  Rng rng(7);
  const Scene scene = makeStreet(30, 0.05, rng);
  Scene other = scene;
  for (const double far_m : {1e11, -1e30, 1e100}) {
    other.objects.push_back(scene.objects.front());
    other.objects.back().position_m = {far_m, far_m, 0.0};
  }
  EXPECT_EQ(descriptorOf(other), descriptorOf(scene));
}

TEST(PairDescriptorTest, TheSamePlaceIsMoreAlikeThanAnyOther) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(50 + seed);
    const Scene scene = makeStreet(30, 0.1, rng);
    const double same =
        descriptorSimilarity(descriptorOf(scene), descriptorOf(seenFrom(scene, planarPose(1.0, 1.0, 2.0), rng)));
    for (int i = 0; i < 10; ++i) {
      EXPECT_GT(same, descriptorSimilarity(descriptorOf(scene), descriptorOf(makeStreet(30, 0.1, rng))));
    }
    EXPECT_LE(same, 1.0);
  }
}

TEST(PairDescriptorTest, ScenesWithoutPairsAreLikeNothing) {
  Rng rng(1);
  const Scene street = makeStreet(20, 0.1, rng);
  Scene one;
  one.objects.push_back(street.objects.front());
  EXPECT_EQ(descriptorSimilarity(descriptorOf(one), descriptorOf(street)), 0.0);
  EXPECT_EQ(descriptorSimilarity(descriptorOf({}), descriptorOf({})), 0.0);
}

}  // namespace
}  // namespace semantic_mht_slam
