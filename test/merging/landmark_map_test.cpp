#include "semantic_mht_slam/merging/landmark_map.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/merging/map_merger.h"

#include "support/square_drive.h"

namespace semantic_mht_slam {
namespace {

/// A field with trees and poles.
std::vector<BareLandmark> makeField(Rng& rng, int count, double side_m) {
  std::vector<BareLandmark> field;
  for (int i = 0; i < count; ++i) {
    field.push_back({i % 3 == 0 ? 1 : 0, {rng.uniform(0.0, side_m), rng.uniform(0.0, side_m), rng.uniform(-0.3, 0.3)}});
  }
  return field;
}

/// Nine in ten of the landmarks, with noise, in a frame of their own.
std::vector<BareLandmark> seenIn(const Pose& T_own_field, const std::vector<BareLandmark>& field, Rng& rng) {
  std::vector<BareLandmark> seen;
  for (const BareLandmark& landmark : field) {
    if (!rng.bernoulli(0.9)) continue;
    const Eigen::Vector3d noise_m(rng.normal(0.0, 0.1), rng.normal(0.0, 0.1), rng.normal(0.0, 0.1));
    seen.push_back({landmark.class_index, T_own_field * (landmark.position_m + noise_m)});
  }
  return seen;
}

Pose anywhere(Rng& rng) {
  return {expRotation({0.0, 0.0, rng.uniform(-M_PI, M_PI)}),
          {rng.uniform(-100.0, 100.0), rng.uniform(-100.0, 100.0), rng.uniform(-10.0, 10.0)}};
}

TEST(LandmarkMapTest, MapsOfOneFieldJoinAndThoseOfAnotherDoNot) {
  const ClassTable classes = makeStreetClasses();
  const SlamConfig config = defaultsOf(Method::kDpmhm);
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    const auto field = makeField(rng, 60, 80.0);
    const auto other_field = makeField(rng, 60, 80.0);
    const Pose T_a = anywhere(rng);
    const Pose T_b = anywhere(rng);
    const SlamParts a = makeLandmarkMap(seenIn(T_a, field, rng), config, classes);
    const SlamParts b = makeLandmarkMap(seenIn(T_b, field, rng), config, classes);
    const SlamParts other = makeLandmarkMap(seenIn(anywhere(rng), other_field, rng), config, classes);
    std::vector<MergeMap> maps;
    maps.emplace_back("a", a);
    maps.emplace_back("b", b);
    maps.emplace_back("other", other);
    const MergeResult result = mergeMaps(maps, config, classes);
    ASSERT_EQ(result.groups.size(), 2U) << seed;
    ASSERT_EQ(result.groups[0].maps, (std::vector<std::size_t>{0, 1})) << seed;
    const JoinedMap& joined = *result.groups[0].joined;
    const KeyframeId first_b(joined.members[1].first_keyframe);
    const Pose T_joined_b = joined.parts.map.T_map_keyframe(first_b) * b.map.T_map_keyframe(KeyframeId(0)).inverse();
    const Eigen::Vector3d middle_m(40.0, 40.0, 0.0);
    EXPECT_LT((T_joined_b * (T_b * middle_m) - T_a * middle_m).norm(), 0.3) << seed;
  }
}

TEST(LandmarkMapTest, TwoLandmarksAreNoMap) {
  EXPECT_THROW(makeLandmarkMap(std::vector<BareLandmark>(2), defaultsOf(Method::kDpmhm), makeStreetClasses()),
               InputError);
}

}  // namespace
}  // namespace semantic_mht_slam
