#include "semantic_mht_slam/evaluation/association_score.h"

#include <algorithm>
#include <random>
#include <stdexcept>

#include <gtest/gtest.h>

namespace semantic_mht_slam {
namespace {

struct Scenario {
  std::vector<TrueDetection> truth;
  std::vector<AssociatedDetection> associations;
};

/// Detections of ten landmarks, clutter and movers, associated with many mistakes.
Scenario randomScenario(unsigned seed) {
  std::mt19937 engine(seed);
  const auto draw = [&](int low, int high) { return static_cast<std::int64_t>(engine() % (high - low + 1)) + low; };
  Scenario scenario;
  for (std::int64_t frame = 0; frame < 900; frame += 30) {
    const std::int64_t rows = draw(0, 6);
    for (std::int64_t row = 0; row < rows; ++row) {
      const std::int64_t truth = draw(-2, 9);
      scenario.truth.push_back({frame, truth});
      scenario.associations.push_back({frame, row, draw(0, 2) == 0 ? draw(-1, 9) : std::max<std::int64_t>(-1, truth)});
    }
  }
  return scenario;
}

/// The definition, pair by pair.
PairwiseScore bruteForce(const Scenario& scenario, std::int64_t window_frames) {
  double both = 0.0;
  double together = 0.0;
  double same = 0.0;
  for (std::size_t i = 0; i < scenario.truth.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const TrueDetection& a = scenario.truth[i];
      const TrueDetection& b = scenario.truth[j];
      if (a.landmark < 0 || b.landmark < 0 || a.frame / window_frames != b.frame / window_frames) continue;
      const std::int64_t estimate = scenario.associations[i].landmark;
      const bool is_same = a.landmark == b.landmark;
      const bool is_together = estimate >= 0 && estimate == scenario.associations[j].landmark;
      same += is_same ? 1.0 : 0.0;
      together += is_together ? 1.0 : 0.0;
      both += is_same && is_together ? 1.0 : 0.0;
    }
  }
  const double precision = both / std::max(1.0, together);
  const double recall = both / std::max(1.0, same);
  return {precision, recall, 2.0 * precision * recall / std::max(1e-12, precision + recall)};
}

void expectEqual(const PairwiseScore& a, const PairwiseScore& b) {
  EXPECT_NEAR(a.precision, b.precision, 1e-12);
  EXPECT_NEAR(a.recall, b.recall, 1e-12);
  EXPECT_NEAR(a.f1, b.f1, 1e-12);
}

class AssociationScoreTest : public ::testing::TestWithParam<unsigned> {};

TEST_P(AssociationScoreTest, EqualsTheCountOfAllPairs) {
  const Scenario scenario = randomScenario(GetParam());
  const AssociationScore score = associationScore(scenario.truth, scenario.associations);
  expectEqual(score.all, bruteForce(scenario, 1000000));
  expectEqual(score.local, bruteForce(scenario, 300));
}

TEST_P(AssociationScoreTest, DoesNotDependOnOrderOrNamesOfLandmarks) {
  Scenario scenario = randomScenario(GetParam());
  const AssociationScore before = associationScore(scenario.truth, scenario.associations);
  std::shuffle(scenario.associations.begin(), scenario.associations.end(), std::mt19937(GetParam()));
  for (AssociatedDetection& detection : scenario.associations) {
    if (detection.landmark >= 0) detection.landmark = 1000 - 7 * detection.landmark;
  }
  const AssociationScore after = associationScore(scenario.truth, scenario.associations);
  expectEqual(before.all, after.all);
  expectEqual(before.local, after.local);
  EXPECT_EQ(before.clutter_accepted, after.clutter_accepted);
}

INSTANTIATE_TEST_SUITE_P(Seeds, AssociationScoreTest, ::testing::Range(0U, 20U));

TEST(AssociationScoreTest, RightAssociationsScoreOne) {
  const std::vector<TrueDetection> truth = {{0, 5}, {0, -1}, {1, 5}, {400, 5}, {400, 6}, {401, 6}};
  const AssociationScore score =
      associationScore(truth, {{0, 0, 1}, {0, 1, -1}, {1, 0, 1}, {400, 0, 1}, {400, 1, 2}, {401, 0, 2}});
  EXPECT_EQ(score.all.f1, 1.0);
  EXPECT_EQ(score.local.f1, 1.0);
  EXPECT_EQ(score.clutter_accepted, 0.0);
  EXPECT_EQ(score.static_rejected, 0.0);
}

TEST(AssociationScoreTest, AnUnmergedRevisitCostsRecallOverAllPairsOnly) {
  const std::vector<TrueDetection> truth = {{0, 5}, {1, 5}, {400, 5}, {401, 5}};
  const AssociationScore score = associationScore(truth, {{0, 0, 1}, {1, 0, 1}, {400, 0, 2}, {401, 0, 2}});
  EXPECT_EQ(score.local.recall, 1.0);
  EXPECT_NEAR(score.all.recall, 2.0 / 6.0, 1e-12);
  EXPECT_EQ(score.all.precision, 1.0);
}

TEST(AssociationScoreTest, CountsClutterAndRejectionsButNotMovers) {
  const std::vector<TrueDetection> truth = {{0, -1}, {0, -1}, {0, -2}, {0, 3}, {0, 4}, {1, 4}};
  const AssociationScore score = associationScore(truth, {{0, 0, 9}, {0, 1, -1}, {0, 2, 9}, {0, 3, -1}, {0, 4, 8}});
  EXPECT_EQ(score.scored_detections, 5);
  EXPECT_EQ(score.true_detections, 6);
  EXPECT_EQ(score.clutter_accepted, 0.5);
  EXPECT_EQ(score.static_rejected, 0.5);
}

TEST(AssociationScoreTest, NothingAssociatedScoresZero) {
  const AssociationScore score = associationScore({{0, 1}}, {});
  EXPECT_EQ(score.all.f1, 0.0);
  EXPECT_EQ(score.static_rejected, 0.0);
  EXPECT_EQ(score.true_detections, 1);
}

TEST(AssociationScoreTest, RefusesDetectionsThatTheTruthDoesNotHave) {
  const std::vector<TrueDetection> truth = {{0, 1}, {0, 2}};
  EXPECT_THROW(associationScore(truth, {{0, 2, 1}}), std::invalid_argument);
  EXPECT_THROW(associationScore(truth, {{1, 0, 1}}), std::invalid_argument);
  EXPECT_THROW(associationScore(truth, {{0, -1, 1}}), std::invalid_argument);
  EXPECT_THROW(associationScore(truth, {{0, 0, -2}}), std::invalid_argument);
  EXPECT_THROW(associationScore(truth, {{0, 0, 1}, {0, 0, 1}}), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
