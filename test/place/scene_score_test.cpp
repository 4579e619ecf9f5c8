#include "semantic_mht_slam/place/scene_score.h"

#include <gtest/gtest.h>

#include "place/scenes.h"

namespace semantic_mht_slam {
namespace {

constexpr int kClasses = 6;

SceneScoreConfig configOf(SceneFrame frame, PairScoreFormula formula = PairScoreFormula::kSimilarity) {
  SceneScoreConfig config;
  config.frame = frame;
  config.formula = formula;
  return config;
}

TEST(SceneScoreTest, IsOneForASceneAndItself) {
  Rng rng(1);
  const Scene scene = randomScene(20, kClasses, rng);
  EXPECT_NEAR(sceneScore(scene, scene, configOf(SceneFrame::kBase)), 1.0, 1e-12);
  EXPECT_NEAR(sceneScore(scene, scene, configOf(SceneFrame::kPrincipal)), 1.0, 1e-12);
}

TEST(SceneScoreTest, InPrincipalAxesIgnoresWhereTheSceneIsSeenFrom) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const Scene scene = randomScene(20, kClasses, rng);
    const Scene turned = seenFrom(scene, rng.uniform(-M_PI, M_PI), {8.0, 2.0, -1.0}, 0.0, rng);
    EXPECT_NEAR(sceneScore(scene, turned, configOf(SceneFrame::kPrincipal)), 1.0, 1e-9) << "seed " << seed;
  }
}

TEST(SceneScoreTest, InTheBaseFrameIgnoresTheDirectionOfTravelButNotAnotherHeading) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Rng rng(seed);
    const Scene scene = randomScene(20, kClasses, rng);
    const auto scoreAt = [&](double yaw_rad) {
      return sceneScore(scene, seenFrom(scene, yaw_rad, Eigen::Vector3d::Zero(), 0.0, rng),
                        configOf(SceneFrame::kBase));
    };
    EXPECT_NEAR(scoreAt(M_PI), 1.0, 1e-9);
    EXPECT_LT(scoreAt(0.5 * M_PI), 0.8) << "seed " << seed;
  }
}

TEST(SceneScoreTest, IsSymmetricAndInTheUnitInterval) {
  for (const SceneFrame frame : {SceneFrame::kBase, SceneFrame::kPrincipal}) {
    for (const PairScoreFormula formula : {PairScoreFormula::kSimilarity, PairScoreFormula::kAsPrinted}) {
      for (std::uint64_t seed = 1; seed <= 30; ++seed) {
        Rng rng(seed);
        const Scene a = randomScene(5 + static_cast<int>(rng.index(20)), kClasses, rng);
        const Scene b = randomScene(5 + static_cast<int>(rng.index(20)), kClasses, rng);
        const double score = sceneScore(a, b, configOf(frame, formula));
        EXPECT_NEAR(score, sceneScore(b, a, configOf(frame, formula)), 1e-9) << "seed " << seed;
        EXPECT_GE(score, 0.0);
        EXPECT_LE(score, 1.0);
      }
    }
  }
}

TEST(SceneScoreTest, IsNeverAboveItsBound) {
  for (const SceneFrame frame : {SceneFrame::kBase, SceneFrame::kPrincipal}) {
    for (const PairScoreFormula formula : {PairScoreFormula::kSimilarity, PairScoreFormula::kAsPrinted}) {
      SceneScoreConfig config;
      config.frame = frame;
      config.formula = formula;
      for (std::uint64_t seed = 0; seed < 50; ++seed) {
        Rng rng(seed);
        const Scene a = randomScene(5 + static_cast<int>(rng.index(25)), 3, rng);
        const Scene b = seed % 2 == 0 ? randomScene(20, 3, rng) : seenFrom(a, M_PI, Eigen::Vector3d::Zero(), 0.5, rng);
        EXPECT_LE(sceneScore(a, b, config), sceneScoreBound(a, b, config)) << "seed " << seed;
      }
    }
  }
}

TEST(SceneScoreTest, IsTheMeanOfDistanceAndClassOfThePairs) {
  SceneScoreConfig config = configOf(SceneFrame::kBase);
  config.min_objects = 1;
  config.max_distance_m = 4.0;
  config.class_penalty = 0.5;
  Rng rng(1);
  Scene a = randomScene(2, 1, rng);
  a.objects[0].position_m = {0.0, 0.0, 0.0};
  a.objects[1].position_m = {100.0, 0.0, 0.0};
  Scene b = a;
  b.objects[0].position_m.x() += 1.0;  // s_match = 3/4
  b.objects[1].position_m.y() += 2.0;  // s_match = 1/2, and another class
  b.objects[1].class_index = 1;
  EXPECT_NEAR(sceneScore(a, b, config), (0.75 + 0.5 * 0.5) / 2.0, 1e-12);
  config.formula = PairScoreFormula::kAsPrinted;
  EXPECT_NEAR(sceneScore(a, b, config), (1.0 + (1.0 - 0.5 * 0.5)) / 2.0, 1e-12);
}

TEST(SceneScoreTest, FallsWithNoiseAndWithConfusedClasses) {
  Rng rng(7);
  const Scene scene = randomScene(20, kClasses, rng);
  const auto config = configOf(SceneFrame::kBase);
  const double little = sceneScore(scene, seenFrom(scene, 0.0, Eigen::Vector3d::Zero(), 0.1, rng), config);
  const double much = sceneScore(scene, seenFrom(scene, 0.0, Eigen::Vector3d::Zero(), 1.0, rng), config);
  Scene confused = scene;
  for (SceneObject& object : confused.objects) object.class_index = (object.class_index + 1) % kClasses;
  EXPECT_GT(little, much);
  EXPECT_NEAR(sceneScore(scene, confused, config), 1.0 - config.class_penalty, 1e-12);
}

TEST(SceneScoreTest, IsZeroForScenesWithTooFewObjects) {
  Rng rng(8);
  const Scene few = randomScene(4, kClasses, rng);
  EXPECT_EQ(sceneScore(few, few, configOf(SceneFrame::kBase)), 0.0);
  EXPECT_EQ(sceneScore(Scene{}, Scene{}, configOf(SceneFrame::kPrincipal)), 0.0);
}

TEST(SceneScoreTest, IsFiniteForObjectsAtOnePointAndOnALine) {
  Rng rng(9);
  Scene scene = randomScene(8, kClasses, rng);
  for (SceneObject& object : scene.objects) object.position_m.tail<2>().setZero();
  EXPECT_NEAR(sceneScore(scene, scene, configOf(SceneFrame::kPrincipal)), 1.0, 1e-9);
  for (SceneObject& object : scene.objects) object.position_m.setConstant(1.0);
  EXPECT_NEAR(sceneScore(scene, scene, configOf(SceneFrame::kPrincipal)), 1.0, 1e-9);
}

}  // namespace
}  // namespace semantic_mht_slam
