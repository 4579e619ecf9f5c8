#include "semantic_mht_slam/place/covisibility.h"

#include <cmath>

#include <gtest/gtest.h>

#include "place/scenes.h"

namespace semantic_mht_slam {
namespace {

Scene sceneOf(const std::vector<std::pair<LandmarkId, double>>& landmarks_at_x) {
  Scene scene;
  for (const auto& [id, x_m] : landmarks_at_x) {
    SceneObject object;
    object.landmark = id;
    object.position_m = {x_m, 0.0, 0.0};
    scene.objects.push_back(object);
  }
  return scene;
}

TEST(CovisibilityTest, WeightIsTheShareOfCommonKeyframesTimesTheKernelAtTheMeanDistance) {
  CovisibilityConfig config;
  config.distance_scale_m = 4.0;
  CovisibilityGraph graph(config);
  graph.addKeyframe(sceneOf({{1, 0.0}, {2, 3.0}}));
  graph.addKeyframe(sceneOf({{1, 0.0}, {2, 5.0}}));
  graph.addKeyframe(sceneOf({{1, 0.0}}));
  EXPECT_EQ(graph.timesSeenTogether(1, 2), 2);
  EXPECT_NEAR(graph.weight(1, 2), 2.0 / 3.0 * std::exp(-0.5), 1e-12);
}

TEST(CovisibilityTest, WeightsAreSymmetricAndInTheUnitInterval) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    CovisibilityGraph graph(CovisibilityConfig{});
    for (int k = 0; k < 10; ++k) graph.addKeyframe(withLandmarks(randomScene(8, 3, rng), 1 + rng.index(10)));
    for (LandmarkId a = 1; a <= 18; ++a) {
      for (LandmarkId b = 1; b <= 18; ++b) {
        EXPECT_EQ(graph.weight(a, b), graph.weight(b, a));
        EXPECT_GE(graph.weight(a, b), 0.0);
        EXPECT_LE(graph.weight(a, b), 1.0);
      }
    }
  }
}

TEST(CovisibilityTest, NearerLandmarksAndThoseSeenTogetherMoreOftenWeighMore) {
  CovisibilityGraph graph(CovisibilityConfig{});
  graph.addKeyframe(sceneOf({{1, 0.0}, {2, 2.0}, {3, 8.0}, {4, 2.0}}));
  graph.addKeyframe(sceneOf({{1, 0.0}, {2, 2.0}}));
  EXPECT_GT(graph.weight(1, 4), graph.weight(1, 3));
  EXPECT_GT(graph.weight(1, 2), graph.weight(1, 4));
}

TEST(CovisibilityTest, UnknownLandmarksDetectionsAndTheLandmarkItselfHaveNoEdge) {
  CovisibilityGraph graph(CovisibilityConfig{});
  graph.addKeyframe(sceneOf({{1, 0.0}, {kNoLandmark, 1.0}, {2, 2.0}, {1, 0.5}}));
  EXPECT_EQ(graph.timesSeen(1), 1);
  EXPECT_EQ(graph.timesSeen(kNoLandmark), 0);
  EXPECT_EQ(graph.weight(1, 1), 0.0);
  EXPECT_EQ(graph.weight(1, 9), 0.0);
  EXPECT_EQ(graph.weight(kNoLandmark, 2), 0.0);
}

TEST(CovisibilityTest, NeighboursHaveAtLeastTheGivenWeight) {
  CovisibilityGraph graph(CovisibilityConfig{});
  graph.addKeyframe(sceneOf({{1, 0.0}, {2, 1.0}, {3, 40.0}}));
  EXPECT_EQ(graph.neighbours(1, 0.5), (std::vector<LandmarkId>{2}));
  EXPECT_EQ(graph.neighbours(1, 0.0), (std::vector<LandmarkId>{2, 3}));
  EXPECT_TRUE(graph.neighbours(7, 0.0).empty());
}

TEST(CovisibilityTest, ASceneRegainsTheLandmarkThatTheKeyframeMissedButNotAStranger) {
  CovisibilityGraph graph(CovisibilityConfig{});
  for (int i = 0; i < 5; ++i) graph.addKeyframe(sceneOf({{1, 0.0}, {2, 1.0}, {3, 2.0}}));
  const Scene seen = sceneOf({{1, 10.0}, {2, 11.0}});
  const Scene nearby = sceneOf({{1, 10.0}, {2, 11.0}, {3, 12.0}, {4, 13.0}});
  const Scene scene = graph.sceneOf(seen, nearby, 0.5);
  ASSERT_EQ(scene.objects.size(), 3u);
  EXPECT_EQ(scene.objects[2].landmark, 3u);
  EXPECT_EQ(scene.objects[2].position_m.x(), 12.0);
}

}  // namespace
}  // namespace semantic_mht_slam
