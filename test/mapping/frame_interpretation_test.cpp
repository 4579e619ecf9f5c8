#include "semantic_mht_slam/mapping/frame_interpretation.h"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/log_math.h"

#include "mapping/hypothesis_tree_test_util.h"

namespace semantic_mht_slam {
namespace {

FrameInterpretation makeInterpretation(std::size_t leaf, double weight, std::vector<LandmarkId> landmarks,
                                       int new_landmarks = 0) {
  FrameInterpretation interpretation;
  interpretation.leaf = leaf;
  interpretation.log_weight = std::log(weight);
  interpretation.landmark_of_measurement = std::move(landmarks);
  interpretation.new_landmarks = new_landmarks;
  return interpretation;
}

/// All readings of one detection at 10.2 m by a leaf with one landmark at 10 m.
std::vector<FrameInterpretation> readingsOf(const HypothesisLandmark& landmark, const MapperConfig& config) {
  const ClassTable table = makeTable();
  const AssociationModel model(config, table);
  const LandmarkTracking tracking(config, table);
  MapHypothesis leaf;
  leaf.landmarks = {landmark};
  if (landmark->is_expected) leaf.map_offset.emplace();
  const TreeInput input = makeInputOf({makeMeasurement({10.2, 0.0, 0.0}, 100)});
  LeafExpansion expansion;
  expansion.measurements = input.measurements;
  model.formulate(leaf, expansion.measurements, 0.0, expansion.problem);
  tracking.lookOut(leaf, input, expansion.outlooks);
  KBestOptions options;
  options.max_assignments = 10;
  KBestSolver solver;
  const AssignmentList& assignments = solver.solve(expansion.problem.costs, options);
  FrameInterpreter interpreter(config, model, leaf, expansion);
  std::vector<FrameInterpretation> readings;
  for (int i = 0; i < assignments.size(); ++i) addInterpretation(interpreter.interpret(assignments, i), readings);
  return readings;
}

HypothesisLandmark expectedPole() {
  const HypothesisLandmark pole = makePole(10.0, 5);
  auto expected = std::make_shared<TrackedLandmark>(*pole);
  expected->is_expected = true;
  return {std::move(expected), pole.existence};
}

TEST(FrameInterpretationTest, ADetectionIsALandmarkNewOrAFalsePositive) {
  MapperConfig config;
  config.association.split_prob = 0.0;
  const auto readings = readingsOf(makePole(10.0, 5), config);
  ASSERT_EQ(readings.size(), 3U);
  std::map<LandmarkId, int> counts;
  for (const FrameInterpretation& reading : readings) {
    ++counts[reading.landmark_of_measurement.at(0)];
    EXPECT_EQ(reading.new_landmarks, reading.landmark_of_measurement[0] == 100 ? 1 : 0);
    EXPECT_EQ(reading.false_positives, reading.landmark_of_measurement[0] == kNoLandmark ? 1 : 0);
  }
  EXPECT_EQ(counts, (std::map<LandmarkId, int>{{1, 1}, {100, 1}, {kNoLandmark, 1}}));
}

TEST(FrameInterpretationTest, NewOrExpectedByTheEarlierMapIsNoBranch) {
  MapperConfig config;
  config.association.split_prob = 0.0;
  const auto readings = readingsOf(expectedPole(), config);
  ASSERT_EQ(readings.size(), 2U) << "one landmark, be it the expected one or not, or a false positive";
  const FrameInterpretation& found = readings.front();
  EXPECT_EQ(found.landmark_of_measurement.at(0), 100U);
  EXPECT_EQ(found.roles.at(0).kind, MeasurementRole::Kind::kLandmark) << "the likelier of the two stays";
  EXPECT_EQ(found.expected_found, 1);
  EXPECT_NEAR(found.expected_missed, 0.0, 1e-12);
  const FrameInterpretation& missed = readings.back();
  EXPECT_EQ(missed.expected_found, 0);
  EXPECT_GT(missed.expected_missed, 0.1);
}

TEST(FrameInterpretationTest, OfReadingsThatSayTheSameTheLikelierStaysWithTheWeightOfBoth) {
  std::vector<FrameInterpretation> readings;
  addInterpretation(makeInterpretation(0, 0.2, {100}, 1), readings);
  addInterpretation(makeInterpretation(0, 0.5, {100}, 0), readings);
  addInterpretation(makeInterpretation(0, 0.1, {kNoLandmark}), readings);
  addInterpretation(makeInterpretation(1, 0.2, {100}, 2), readings);
  ASSERT_EQ(readings.size(), 3U) << "another leaf is another hypothesis";
  EXPECT_NEAR(readings[0].log_weight, std::log(0.7), 1e-12);
  EXPECT_EQ(readings[0].new_landmarks, 0);
  EXPECT_NEAR(readings[2].log_weight, std::log(0.2), 1e-12);
}

TEST(FrameInterpretationTest, UnlikelyReadingsAreDroppedButNeverTheLikeliest) {
  std::vector<FrameInterpretation> readings = {makeInterpretation(0, 6.0, {1}), makeInterpretation(0, 0.5, {2}),
                                               makeInterpretation(0, 3.5, {3})};
  dropUnlikely(std::log(0.1), readings);
  ASSERT_EQ(readings.size(), 2U);
  EXPECT_NEAR(readings[0].log_weight, std::log(0.6), 1e-12);
  EXPECT_NEAR(readings[1].log_weight, std::log(0.35), 1e-12);
  dropUnlikely(std::log(0.9), readings);
  ASSERT_EQ(readings.size(), 1U);
  EXPECT_EQ(readings[0].landmark_of_measurement, std::vector<LandmarkId>{1});
}

}  // namespace
}  // namespace semantic_mht_slam
