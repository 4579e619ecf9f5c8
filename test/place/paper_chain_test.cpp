#include "semantic_mht_slam/place/paper_chain.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "place/scenes.h"

namespace semantic_mht_slam {
namespace {

constexpr int kClasses = 6;
constexpr double kKeyframeStep_m = 3.0;
constexpr int kKeyframesOfSubmap = 10;
constexpr int kRouteKeyframes = 100;

// A straight street with other classes prevailing in each stretch of 30 m, driven from one end to the other.
struct Street {
  explicit Street(std::uint64_t seed) {
    Rng rng(seed);
    for (int i = 0; i < 400; ++i) {
      const double x_m = rng.uniform(-20.0, kRouteKeyframes * kKeyframeStep_m + 20.0);
      SceneObject object;
      object.position_m = {x_m, rng.uniform(4.0, 15.0) * (rng.bernoulli(0.5) ? 1.0 : -1.0), rng.uniform(0.0, 2.0)};
      const auto common_class = static_cast<std::uint64_t>(std::abs(std::floor(x_m / 30.0)));
      object.class_index = static_cast<ClassIndex>(rng.bernoulli(0.4) ? (5 * common_class + common_class / 3) % kClasses
                                                                      : rng.index(kClasses));
      object.landmark = static_cast<LandmarkId>(i + 1);
      objects.push_back(object);
    }
  }

  std::vector<SceneObject> objects;  ///< street frame
};

// Keyframe `number` of a drive whose keyframe `number % kRouteKeyframes` is at that place of the street. A later pass
// maps the street anew, in the other direction if it is a return.
Keyframe keyframeOf(const Street& street, int number, bool is_return, Rng& rng) {
  const int pass = number / kRouteKeyframes;
  const int place = is_return ? kRouteKeyframes - 1 - number % kRouteKeyframes : number % kRouteKeyframes;
  const Pose T_street_base{expRotation({0.0, 0.0, is_return ? M_PI : 0.0}), {place * kKeyframeStep_m, 0.5 * pass, 0.0}};
  Keyframe keyframe;
  keyframe.frame = static_cast<std::size_t>(number);
  keyframe.submap = SubmapId(number / kKeyframesOfSubmap);
  keyframe.driven_m = number * kKeyframeStep_m;
  for (SceneObject object : street.objects) {
    object.position_m = T_street_base.inverse() * object.position_m +
                        Eigen::Vector3d(rng.normal(0.0, 0.1), rng.normal(0.0, 0.1), rng.normal(0.0, 0.1));
    object.landmark += static_cast<LandmarkId>(pass * 1000);
    if (object.position_m.norm() < 25.0 && rng.bernoulli(0.95)) keyframe.scene.objects.push_back(object);
  }
  return keyframe;
}

ClassHistogram histogramOf(const std::vector<Keyframe>& keyframes) {
  Scene all;
  for (const Keyframe& keyframe : keyframes) {
    all.objects.insert(all.objects.end(), keyframe.scene.objects.begin(), keyframe.scene.objects.end());
  }
  return classHistogram(all, kClasses);
}

struct Answer {
  Keyframe query;
  std::vector<PaperCandidate> candidates;
};

// Drives the street twice; the answers to every keyframe, each asked when its submap is full.
std::vector<Answer> driveTwice(const PaperChainConfig& config, std::uint64_t seed, bool is_return) {
  const Street street(seed);
  Rng rng(seed + 1000);
  PaperChain chain(config, kClasses);
  std::vector<Answer> answers;
  for (int submap = 0; submap < 2 * kRouteKeyframes / kKeyframesOfSubmap; ++submap) {
    std::vector<Keyframe> keyframes;
    for (int i = 0; i < kKeyframesOfSubmap; ++i) {
      const int number = submap * kKeyframesOfSubmap + i;
      keyframes.push_back(keyframeOf(street, number, is_return && number >= kRouteKeyframes, rng));
    }
    const ClassHistogram histogram = histogramOf(keyframes);
    chain.add(histogram, keyframes);
    for (const Keyframe& keyframe : keyframes) answers.push_back({keyframe, chain.query(keyframe, histogram)});
  }
  return answers;
}

int placeOf(std::size_t frame, bool is_return) {
  const auto number = static_cast<int>(frame);
  return is_return && number >= kRouteKeyframes ? 2 * kRouteKeyframes - 1 - number : number % kRouteKeyframes;
}

struct Count {
  int proposed = 0;
  int right = 0;
};

Count countProposed(const std::vector<Answer>& answers, bool is_return) {
  Count count;
  for (const auto& [query, candidates] : answers) {
    if (candidates.empty() || candidates.front().refusal != PlaceRefusal::kNone) continue;
    ++count.proposed;
    const int error = std::abs(placeOf(candidates.front().frame, is_return) - placeOf(query.frame, is_return));
    if (error <= 3) ++count.right;
  }
  return count;
}

TEST(PaperChainTest, FindsMostRevisitsInBothDirectionsWithFewWrongOnes) {
  for (const bool is_return : {false, true}) {
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      const Count count = countProposed(driveTwice(PaperChainConfig{}, seed, is_return), is_return);
      EXPECT_GE(count.right, kRouteKeyframes / 2) << "seed " << seed << (is_return ? ", return" : "");
      EXPECT_LE(count.proposed - count.right, kRouteKeyframes / 10) << "seed " << seed;
    }
  }
}

TEST(PaperChainTest, CandidatesAreRankedNotRecentAndCarryTheirScores) {
  const PaperChainConfig config;
  int all = 0;
  for (const auto& [query, candidates] : driveTwice(config, 3, false)) {
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const PaperCandidate& candidate = candidates[i];
      EXPECT_LE(static_cast<double>(candidate.frame) * kKeyframeStep_m, query.driven_m - config.recent_m);
      EXPECT_LE(candidate.histogram_divergence, config.max_divergence);
      EXPECT_LE(candidate.scene_distance, config.max_scene_distance);
      EXPECT_GE(candidate.topology_score, -1.0);
      EXPECT_EQ(candidate.submap.index(), candidate.frame / kKeyframesOfSubmap);
      EXPECT_GE(candidates.front().score(), candidate.score());
      EXPECT_GE(candidate.score(), candidates.back().score());
      EXPECT_TRUE(candidate.refusal != PlaceRefusal::kNone || candidate.score() >= config.min_score);
      EXPECT_TRUE(candidate.refusal != PlaceRefusal::kNone || candidate.loop_prob >= config.filter.min_loop_prob);
      ++all;
    }
  }
  EXPECT_GT(all, 100);
}

TEST(PaperChainTest, TheSameDriveGivesTheSameAnswers) {
  const auto first = driveTwice(PaperChainConfig{}, 4, true);
  const auto second = driveTwice(PaperChainConfig{}, 4, true);
  for (std::size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].candidates.size(), second[i].candidates.size());
    for (std::size_t k = 0; k < first[i].candidates.size(); ++k) {
      EXPECT_EQ(first[i].candidates[k].frame, second[i].candidates[k].frame);
      EXPECT_EQ(first[i].candidates[k].score(), second[i].candidates[k].score());
    }
  }
}

TEST(PaperChainTest, EmptyScenesAndScenesOfOneClassAreNeverProposed) {
  PaperChain chain(PaperChainConfig{}, kClasses);
  Rng rng(1);
  for (int submap = 0; submap < 20; ++submap) {
    Keyframe keyframe;
    keyframe.frame = static_cast<std::size_t>(submap);
    keyframe.submap = SubmapId(submap);
    keyframe.driven_m = 100.0 * submap;
    if (submap % 2 == 0) keyframe.scene = randomScene(20, 1, rng);
    const ClassHistogram histogram = classHistogram(keyframe.scene, kClasses);
    chain.add(histogram, {keyframe});
    for (const PaperCandidate& candidate : chain.query(keyframe, histogram)) {
      EXPECT_NE(candidate.refusal, PlaceRefusal::kNone);
      EXPECT_EQ(candidate.submap.index() % 2, 0U) << "an empty scene was found";
    }
  }
}

TEST(PaperChainTest, SubmapsWithoutKeyframesAreNoCandidates) {
  PaperChain chain(PaperChainConfig{}, kClasses);
  Rng rng(2);
  Keyframe keyframe;
  keyframe.driven_m = 1000.0;
  keyframe.scene = randomScene(20, kClasses, rng);
  const ClassHistogram histogram = classHistogram(keyframe.scene, kClasses);
  chain.add(histogram, {});
  EXPECT_TRUE(chain.query(keyframe, histogram).empty());
}

TEST(PaperChainTest, AScoreThatThresholdsCannotReachIsNotComputed) {
  PaperChainConfig config;
  config.min_score = 2.0;
  int pruned = 0;
  for (const auto& [query, candidates] : driveTwice(config, 5, false)) {
    for (const PaperCandidate& candidate : candidates) {
      EXPECT_NE(candidate.refusal, PlaceRefusal::kNone);
      pruned += candidate.scene_score == -1.0 && candidate.refusal == PlaceRefusal::kUnlikeTopology;
    }
  }
  EXPECT_GT(pruned, 0);
}

}  // namespace
}  // namespace semantic_mht_slam
