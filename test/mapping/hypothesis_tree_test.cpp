#include "semantic_mht_slam/mapping/hypothesis_tree.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "semantic_mht_slam/mapping/fusion.h"

#include "mapping/hypothesis_tree_test_util.h"

namespace semantic_mht_slam {
namespace {

/// Landmarks so near each other that detections are ambiguous.
std::vector<HypothesisLandmark> makeLandmarks(Rng& rng, int count) {
  std::vector<HypothesisLandmark> landmarks;
  for (int i = 0; i < count; ++i) {
    auto landmark = std::make_shared<TrackedLandmark>();
    landmark->id = static_cast<LandmarkId>(i + 1);
    landmark->position = {{rng.uniform(0.0, 12.0), rng.uniform(0.0, 12.0), 0.0}, 0.1 * Eigen::Matrix3d::Identity()};
    landmark->class_probs = ClassProbs::Constant(2, 0.5);
    landmark->observations = 1 + static_cast<int>(rng.index(5));
    Existence existence;
    existence.log_odds = 2.0;
    landmarks.push_back({std::move(landmark), existence});
  }
  return landmarks;
}

TreeInput makeInput(Rng& rng, std::size_t frame, int count) {
  TreeInput input;
  input.frame = frame;
  input.driven_m = static_cast<double>(frame);
  input.T_submap_last.translation_m.x() = -1.0;  // driven since
  for (int i = 0; i < count; ++i) {
    Measurement measurement;
    measurement.position_m = {rng.uniform(0.0, 12.0), rng.uniform(0.0, 12.0), rng.normal(0.0, 0.2)};
    measurement.cov_m2 = 0.2 * Eigen::Matrix3d::Identity();
    measurement.outlier_cov_m2.setIdentity();
    measurement.class_index = static_cast<ClassIndex>(rng.index(2));
    measurement.row = i;
    measurement.id_if_new = 1000 * (frame + 1) + static_cast<LandmarkId>(i);
    input.measurements.push_back(measurement);
  }
  return input;
}

std::map<LandmarkId, MixtureLandmark> run(std::uint64_t seed, bool is_reversed, std::size_t& hypotheses) {
  Rng rng(seed);
  MultiHypothesisTree tree({}, makeTable());
  std::vector<HypothesisLandmark> landmarks = makeLandmarks(rng, 30);
  if (is_reversed) std::reverse(landmarks.begin(), landmarks.end());
  tree.restart(landmarks);
  Rng tree_rng(7);
  for (std::size_t frame = 0; frame < 6; ++frame) tree.step(makeInput(rng, frame, 15), tree_rng);
  hypotheses = tree.leaves().size();
  std::map<LandmarkId, MixtureLandmark> result;
  for (const MixtureLandmark& landmark : fuseHypotheses(tree.leaves())) result[landmark.id] = landmark;
  return result;
}

TEST(HypothesisTreeTest, OrderOfLandmarksDoesNotChangeTheResult) {
  std::size_t most_hypotheses = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::size_t hypotheses_a = 0;
    std::size_t hypotheses_b = 0;
    const auto a = run(seed, false, hypotheses_a);
    const auto b = run(seed, true, hypotheses_b);
    EXPECT_EQ(hypotheses_a, hypotheses_b) << "seed " << seed;
    most_hypotheses = std::max(most_hypotheses, hypotheses_a);
    ASSERT_EQ(a.size(), b.size()) << "seed " << seed;
    for (const auto& [id, landmark] : a) {
      ASSERT_EQ(b.count(id), 1U) << "seed " << seed;
      EXPECT_LT((landmark.position.mean_m - b.at(id).position.mean_m).norm(), 1e-9);
      EXPECT_NEAR(landmark.existence_prob, b.at(id).existence_prob, 1e-9);
    }
  }
  EXPECT_GT(most_hypotheses, 1U);  // else nothing was ambiguous
}

/// Every alternative is followed and none is dropped.
MapperConfig makeFullTree() {
  MapperConfig config;
  config.tree.branch_log_ratio = 100.0;
  config.tree.max_branches = 100;
  config.tree.max_hypotheses = 1000;
  config.tree.min_weight = 0.0;
  config.tree.ess_ratio = 0.0;
  return config;
}

/// Log weights by where the only detection of the first frame went; the false positive is 0.
std::map<LandmarkId, double> weightsOfOneDetection(const MapperConfig& config) {
  MultiHypothesisTree tree(config, makeTable());
  tree.restart({makePole(10.0, 20)});
  Rng rng(1);
  tree.step(makeInputOf({makeMeasurement({10.3, 0.2, 0.1}, 100)}), rng);
  std::map<LandmarkId, double> weights;
  for (const MapHypothesis& leaf : tree.leaves()) {
    const LandmarkId id = leaf.history->landmark_of_measurement.front();
    weights[id == kNoLandmark ? 0 : id] = leaf.log_weight;
  }
  return weights;
}

TEST(HypothesisTreeTest, WeightsAreLikelihoodTimesAssignmentPriorWithoutTheCountPrior) {
  for (const CountPrior prior : {CountPrior::kNone, CountPrior::kLinear, CountPrior::kExponential}) {
    MapperConfig config = makeFullTree();
    config.association.count_prior = prior;
    config.association.outlier_prob = 0.0;
    config.association.split_prob = 0.0;
    config.association.new_density = 3.0;
    config.association.false_positive_density = 0.5;
    config.detection.missed_detections = false;
    const auto weights = weightsOfOneDetection(config);
    ASSERT_EQ(weights.size(), 3U);
    const double variance_m2 = 0.05;
    const double log_density = -0.5 * (0.14 / variance_m2) - 1.5 * std::log(2.0 * M_PI * variance_m2);
    const double log_class = std::log(0.99 * 0.9 + 0.01 * 0.1);
    const double log_uniform = -std::log(config.association.map_volume_m3) - std::log(2.0);
    // Poisson(1; 3) Poisson(0; 0.5) and Poisson(0; 3) Poisson(1; 0.5) over Poisson(0; 3) Poisson(0; 0.5)
    EXPECT_NEAR(weights.at(100) - weights.at(1), log_uniform + std::log(3.0) - log_density - log_class, 1e-9);
    EXPECT_NEAR(weights.at(0) - weights.at(1), log_uniform + std::log(0.5) - log_density - log_class, 1e-9);
  }
}

TEST(HypothesisTreeTest, WeightsOfSeenAndMissedLandmarksDifferByTheirDetectionProbability) {
  MapperConfig config = makeFullTree();
  config.association.split_prob = 0.0;
  config.detection.missed_detections = false;
  const auto without = weightsOfOneDetection(config);
  config.detection.missed_detections = true;
  const auto with = weightsOfOneDetection(config);
  const double detection_prob = DetectionRate(config.detection, 2).prob(0, {10.0, 0.0, 0.0});
  const double existence = 1.0 / (1.0 + std::exp(-5.0));
  const double visible = 1.0 - config.detection.visibility_switch_prob;  // it was, for sure
  const double missed = std::log(1.0 - existence * visible * detection_prob);
  const double change = (with.at(100) - with.at(1)) - (without.at(100) - without.at(1));
  EXPECT_NEAR(change, missed - std::log(detection_prob), 1e-3);
}

TEST(HypothesisTreeTest, HypothesesThatForgotWhatSetThemApartAreMerged) {
  MapperConfig config = makeFullTree();
  MultiHypothesisTree tree(config, makeTable());
  Rng rng(1);
  tree.step(makeInputOf({makeMeasurement({10.0, 0.0, 0.0}, 100)}), rng);
  EXPECT_EQ(tree.leaves().size(), 2U);  // new, and a false positive
  for (std::size_t frame = 1; frame < 60; ++frame) tree.step(makeInputOf({}, frame), rng);
  ASSERT_EQ(tree.leaves().size(), 1U);
  EXPECT_NEAR(tree.leaves().front().log_weight, 0.0, 1e-12);
}

TEST(HypothesisTreeTest, AlternativesAreFollowedWithinTheRatioAndUpToTheLimit) {
  const auto leavesWith = [](double branch_log_ratio, int max_branches, int max_hypotheses) {
    MapperConfig config = makeFullTree();
    config.tree.branch_log_ratio = branch_log_ratio;
    config.tree.max_branches = max_branches;
    config.tree.max_hypotheses = max_hypotheses;
    return weightsOfOneDetection(config).size();
  };
  EXPECT_EQ(leavesWith(100.0, 100, 100), 3U);
  EXPECT_EQ(leavesWith(100.0, 2, 100), 2U);
  EXPECT_EQ(leavesWith(0.5, 100, 100), 1U);
  EXPECT_EQ(leavesWith(100.0, 100, 1), 1U);
}

TEST(HypothesisTreeTest, CovariancesTurnWithTheBase) {
  MapperConfig config;
  config.association.concentration = 1e6;  // what is seen is new
  config.tree.max_hypotheses = 1;
  MultiHypothesisTree tree(config, makeTable());
  TreeInput input = makeInputOf({makeMeasurement({10.0, 0.0, 0.0}, 100)});
  input.T_submap_base = Pose{expRotation({0.0, 0.0, M_PI / 2.0}), {1.0, 2.0, 0.0}};
  input.measurements[0].cov_m2.diagonal() << 4.0, 0.01, 0.25;
  Rng rng(1);
  tree.step(input, rng);
  ASSERT_EQ(tree.leaves().front().landmarks.size(), 1U);
  const Gaussian3& position = tree.leaves().front().landmarks.front()->position;
  EXPECT_LT((position.mean_m - Eigen::Vector3d(1.0, 12.0, 0.0)).norm(), 1e-9);
  EXPECT_LT((position.cov_m2.diagonal() - Eigen::Vector3d(0.01, 4.0, 0.25)).norm(), 1e-9);
}

/// How far one detection `error_m` beside a pole with so many observations moves the pose sideways.
double correctionBy(double error_m, int observations) {
  MapperConfig config;
  config.tree.max_hypotheses = 1;
  MultiHypothesisTree tree(config, makeTable());
  tree.restart({makePole(10.0, observations)});
  TreeInput input = makeInputOf({makeMeasurement({10.0, error_m, 0.0}, 100)});
  input.T_submap_last.translation_m.x() = -10.0;  // driven since
  Rng rng(1);
  tree.step(input, rng);
  EXPECT_EQ(tree.leaves().front().history->landmark_of_measurement.front(), 1U);
  return tree.leaves().front().offset.mean.head<3>().norm();
}

TEST(HypothesisTreeTest, OnlySettledLandmarksWithoutOutliersCorrectThePose) {
  EXPECT_GT(correctionBy(0.2, 20), 0.01);
  EXPECT_EQ(correctionBy(0.2, 2), 0.0);
  EXPECT_EQ(correctionBy(1.3, 20), 0.0);
}

}  // namespace
}  // namespace semantic_mht_slam
