#include "semantic_mht_slam/place/scene_alignment.h"

#include <cmath>

#include <gtest/gtest.h>

#include "scene_test_util.h"

namespace semantic_mht_slam {
namespace {

const ClassTable kClasses = makeStreetClasses();

std::vector<SceneAlignment> align(const Scene& query, const Scene& match) {
  return alignScenes(query, match, kClasses, {}, {});
}

TEST(SceneAlignmentTest, TheSamePlaceScoresNearlyAllItsObjects) {
  for (int seed = 0; seed < 20; ++seed) {
    Rng rng(seed);
    const Scene match = makeStreet(30, 0.05, rng);
    const Scene query = seenFrom(match, planarPose(1.0, -2.0, M_PI + rng.normal(0.0, 0.1)), rng);
    const std::vector<SceneAlignment> found = align(query, match);
    ASSERT_FALSE(found.empty()) << "seed " << seed;
    const SceneAlignment& best = found.front();
    EXPECT_EQ(best.pair_classes, 3);
    EXPECT_GT(best.spread_m, 5.0);
    EXPECT_GT(best.soft_inliers, 22.0);
    EXPECT_LE(best.static_inliers, best.soft_inliers);
    EXPECT_GT(best.similarity, 0.8 * best.soft_inliers) << "seed " << seed;
    EXPECT_EQ(checkAlignment(best, rivalSimilarity(found, {}), {}), PlaceRefusal::kNone) << "seed " << seed;
  }
}

TEST(SceneAlignmentTest, ObjectsThatMayDriveAwayCountLess) {
  Rng rng(3);
  const Scene match = makeStreet(30, 0.02, rng);
  PlaceConfig all_alike;
  all_alike.movable_weight = 1.0;
  const auto less = alignScenes(match, match, kClasses, {}, {});
  const auto alike = alignScenes(match, match, kClasses, {}, all_alike);
  ASSERT_FALSE(less.empty());
  ASSERT_FALSE(alike.empty());
  int movable = 0;
  for (const SceneObject& object : match.objects) movable += object.class_index == 2;
  EXPECT_NEAR(alike.front().soft_inliers - less.front().soft_inliers, movable * (1.0 - PlaceConfig{}.movable_weight),
              1e-6);
}

TEST(SceneAlignmentTest, OrderOfObjectsChangesNothing) {
  Rng rng(6);
  const Scene match = makeStreet(30, 0.05, rng);
  const Scene query = seenFrom(match, planarPose(1.0, 2.0, 2.0), rng);
  Scene reversed = query;
  std::reverse(reversed.objects.begin(), reversed.objects.end());
  const std::vector<SceneAlignment> a = align(query, match);
  const std::vector<SceneAlignment> b = align(reversed, match);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_FALSE(a.empty());
  EXPECT_EQ(a.front().mode.T_a_b.translation_m, b.front().mode.T_a_b.translation_m);
  EXPECT_EQ(a.front().similarity, b.front().similarity);
  EXPECT_EQ(a.front().mode.cov, b.front().mode.cov);
}

TEST(SceneAlignmentTest, ARowThatRepeatsItselfHasARival) {
  Scene row;
  for (int i = 0; i < 20; ++i) {
    SceneObject object;
    object.position_m = {5.0 * (i / 2) - 25.0, i % 2 == 0 ? 8.0 : -8.0, 0.0};
    object.cov_m2 = 0.01 * Eigen::Matrix3d::Identity();
    object.class_index = 0;
    row.objects.push_back(object);
  }
  const std::vector<SceneAlignment> found = align(row, row);
  ASSERT_FALSE(found.empty());
  PlaceConfig config;
  config.min_classes = 1;
  EXPECT_EQ(checkAlignment(found.front(), rivalSimilarity(found, config), config), PlaceRefusal::kAmbiguous);
}

TEST(SceneAlignmentTest, AlignmentsOfOnePlaceAreNoRivals) {
  std::vector<SceneAlignment> found(2);
  found[0].similarity = 10.0;
  found[1].similarity = 9.0;
  found[1].mode.T_a_b.translation_m.x() = 0.9 * PlaceConfig{}.agree_m;
  EXPECT_EQ(rivalSimilarity(found, {}), -1.0);
  found[1].mode.T_a_b.translation_m.x() = 1.1 * PlaceConfig{}.agree_m;
  EXPECT_EQ(rivalSimilarity(found, {}), 9.0);
}

TEST(SceneAlignmentTest, ARowOfObjectsAndASingleClassAreRefused) {
  Scene row;
  Rng rng(2);
  for (int i = 0; i < 12; ++i) {
    SceneObject object;
    object.position_m = {rng.uniform(-40.0, 40.0), 8.0, 0.0};
    object.cov_m2 = 0.01 * Eigen::Matrix3d::Identity();
    object.class_index = 0;
    row.objects.push_back(object);
  }
  const std::vector<SceneAlignment> found = align(row, row);
  ASSERT_FALSE(found.empty());
  PlaceConfig config;
  EXPECT_EQ(checkAlignment(found.front(), -1.0, config), PlaceRefusal::kFewClasses);
  config.min_classes = 1;
  EXPECT_EQ(checkAlignment(found.front(), -1.0, config), PlaceRefusal::kOnALine);
}

}  // namespace
}  // namespace semantic_mht_slam
