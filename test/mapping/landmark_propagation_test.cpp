#include "semantic_mht_slam/mapping/landmark_propagation.h"

#include <cmath>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/state_archive.h"

namespace semantic_mht_slam {
namespace {

constexpr double kLength_m = 30.0;
constexpr double kReach_m = 50.0 + kLength_m + 6.0;  // range of detections, a submap, a gate

/// Landmarks go on for ten submaps.
LandmarkPropagation makePropagation() {
  MapperConfig config;
  config.submap.length_m = kLength_m;
  config.submap.propagation_m = 300.0;
  config.detection.max_range_m = 50.0;
  config.association.max_gate_m = 6.0;
  return LandmarkPropagation(config);
}

MixtureLandmark makeLandmark(LandmarkId id, double x_m, std::size_t last_submap) {
  MixtureLandmark landmark;
  landmark.id = id;
  landmark.position = {{x_m, 2.0, 0.5}, 0.04 * Eigen::Matrix3d::Identity()};
  landmark.class_probs = ClassProbs::Constant(2, 0.5);
  landmark.existence_prob = 0.9;
  landmark.observations = 7;
  landmark.last_submap = SubmapId(last_submap);
  return landmark;
}

/// Where submap i begins on a straight drive.
Pose originOf(int submap) {
  Pose pose;
  pose.translation_m.x() = kLength_m * submap;
  return pose;
}

/// Drives on without seeing anything: the landmarks of the last of `submaps` more.
std::vector<HypothesisLandmark> driveOn(LandmarkPropagation& propagation, int from, int submaps) {
  std::vector<HypothesisLandmark> near;
  for (int submap = from; submap < from + submaps; ++submap) {
    if (submap > from) {
      std::vector<MixtureLandmark> fused;
      for (const HypothesisLandmark& landmark : near) {
        fused.push_back(makeLandmark(landmark->id, 0.0, landmark->last_submap.index()));
        fused.back().position = landmark->position;
      }
      propagation.endSubmap(SubmapId(submap - 1), originOf(submap - 1), fused, {});
    }
    near = propagation.beginSubmap(SubmapId(submap), originOf(submap));
  }
  return near;
}

TEST(LandmarkPropagationTest, LandmarksComeInTheFrameOfTheNextSubmap) {
  LandmarkPropagation propagation = makePropagation();
  MapHypothesis best;
  best.offset.mean = {0.5, 0.0, 0.0, 0.0};  // the odometry is half a metre behind
  best.offset.cov.diagonal().head<3>().setConstant(0.01);
  auto hidden = std::make_shared<TrackedLandmark>();
  hidden->id = 3;
  best.landmarks.push_back({hidden, {0.0, 0.25, 1.0}});
  MixtureLandmark landmark = makeLandmark(3, 40.0, 0);
  landmark.first_submap = SubmapId(4);
  propagation.endSubmap(SubmapId(0), originOf(0), {landmark}, best);
  const std::vector<HypothesisLandmark> near = propagation.beginSubmap(SubmapId(1), originOf(1));
  ASSERT_EQ(near.size(), 1u);
  EXPECT_TRUE(near[0]->position.mean_m.isApprox(Eigen::Vector3d(9.5, 2.0, 0.5), 1e-12));
  EXPECT_TRUE(near[0]->position.cov_m2.isApprox(0.05 * Eigen::Matrix3d::Identity(), 1e-12));
  EXPECT_TRUE(near[0]->is_from_earlier_submap);
  EXPECT_EQ(near[0]->observations, 7);
  EXPECT_EQ(near[0]->first_submap.index(), 4U);
  EXPECT_NEAR(near[0].existence.log_odds, std::log(9.0), 1e-12);
  EXPECT_EQ(near[0].existence.visible_prob, 0.25);
}

TEST(LandmarkPropagationTest, CovariancesTurnWithTheFrame) {
  LandmarkPropagation propagation = makePropagation();
  MixtureLandmark landmark = makeLandmark(1, 40.0, 0);
  landmark.position.cov_m2.diagonal() << 0.25, 0.04, 0.09;
  propagation.endSubmap(SubmapId(0), originOf(0), {landmark}, {});
  Pose left = originOf(1);
  left.rotation = Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ());
  const std::vector<HypothesisLandmark> near = propagation.beginSubmap(SubmapId(1), left);
  ASSERT_EQ(near.size(), 1u);
  EXPECT_TRUE(near[0]->position.mean_m.isApprox(Eigen::Vector3d(2.0, -10.0, 0.5), 1e-12));
  EXPECT_TRUE(near[0]->position.cov_m2.diagonal().isApprox(Eigen::Vector3d(0.04, 0.25, 0.09), 1e-12));
}

TEST(LandmarkPropagationTest, WhatTheSubmapCannotSeeRestsUntilItIsNearAgain) {
  LandmarkPropagation propagation = makePropagation();
  const double behind_m = 2.0 * kLength_m - kReach_m;  // at the beginning of submap 2 just out of reach
  std::vector<MixtureLandmark> landmarks = {makeLandmark(1, behind_m - 0.5, 0), makeLandmark(2, behind_m + 0.5, 0),
                                            makeLandmark(3, 20.0, 0)};
  landmarks[1].position.mean_m.z() += 20.0;  // heights don't count
  propagation.endSubmap(SubmapId(0), originOf(0), landmarks, {});
  std::vector<HypothesisLandmark> near = driveOn(propagation, 1, 2);
  ASSERT_EQ(near.size(), 2u);
  EXPECT_EQ(near[0]->id, 2u);
  EXPECT_EQ(near[1]->id, 3u);
  propagation.endSubmap(SubmapId(2), originOf(2), {}, {});
  near = propagation.beginSubmap(SubmapId(3), originOf(0));  // back where it began
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near[0]->id, 1u);
  EXPECT_TRUE(near[0]->position.mean_m.isApprox(Eigen::Vector3d(behind_m - 0.5, 2.0, 0.5), 1e-12));
  EXPECT_EQ(near[0]->last_submap.index(), 0U);
}

TEST(LandmarkPropagationTest, WhatTheSubmapBeforeSawStaysHoweverFarItIs) {
  LandmarkPropagation propagation = makePropagation();
  propagation.endSubmap(SubmapId(0), originOf(0), {makeLandmark(1, kReach_m + kLength_m + 10.0, 0)}, {});
  EXPECT_EQ(propagation.beginSubmap(SubmapId(1), originOf(1)).size(), 1u);
}

TEST(LandmarkPropagationTest, IdsRiseWhateverHasRested) {
  LandmarkPropagation propagation = makePropagation();
  propagation.endSubmap(SubmapId(0), originOf(0),
                        {makeLandmark(1, 50.0, 0), makeLandmark(2, -20.0, 0), makeLandmark(3, 50.0, 0)}, {});
  ASSERT_EQ(driveOn(propagation, 1, 3).size(), 2u);
  propagation.endSubmap(SubmapId(3), originOf(3),
                        {makeLandmark(1, -40.0, 0), makeLandmark(3, -40.0, 0), makeLandmark(4, 0.0, 3)}, {});
  const std::vector<HypothesisLandmark> near = propagation.beginSubmap(SubmapId(4), originOf(1));
  ASSERT_EQ(near.size(), 4u);
  for (LandmarkId id = 1; id <= 4; ++id) EXPECT_EQ(near[id - 1]->id, id);
}

TEST(LandmarkPropagationTest, NothingIsLeftOfForgottenSurroundings) {
  LandmarkPropagation propagation = makePropagation();
  propagation.endSubmap(SubmapId(0), originOf(0), {makeLandmark(1, 0.0, 0), makeLandmark(2, 60.0, 0)}, {});
  ASSERT_EQ(driveOn(propagation, 1, 4).size(), 1u);  // the other one rests
  propagation.clear();
  propagation.endSubmap(SubmapId(4), originOf(4), {}, {});
  EXPECT_TRUE(propagation.beginSubmap(SubmapId(5), originOf(1)).empty());
  propagation.endSubmap(SubmapId(5), originOf(5), {makeLandmark(3, 0.0, 5)}, {});
  propagation.clear();
  EXPECT_TRUE(propagation.beginSubmap(SubmapId(6), originOf(5)).empty());
}

TEST(LandmarkPropagationTest, LandmarksAreForgottenWhenNotSeenForLong) {
  LandmarkPropagation propagation = makePropagation();
  propagation.endSubmap(SubmapId(11), originOf(11), {makeLandmark(1, 0.0, 0), makeLandmark(2, 0.0, 1)}, {});
  const std::vector<HypothesisLandmark> near = propagation.beginSubmap(SubmapId(12), originOf(11));
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near[0]->id, 2u);
  const auto seen_again = [&](int submaps) {
    propagation.clear();
    propagation.endSubmap(SubmapId(0), originOf(0), {makeLandmark(1, 0.0, 0)}, {});
    driveOn(propagation, 1, submaps);  // resting from submap 3 on
    propagation.endSubmap(SubmapId(submaps), originOf(submaps), {}, {});
    return propagation.beginSubmap(SubmapId(submaps + 1), originOf(0)).size() == 1;
  };
  EXPECT_TRUE(seen_again(10));
  EXPECT_FALSE(seen_again(11));
}

TEST(LandmarkPropagationTest, AnIdIsNotTwiceInASubmap) {
  LandmarkPropagation propagation = makePropagation();
  propagation.endSubmap(SubmapId(0), originOf(0), {makeLandmark(1, 0.0, 0), makeLandmark(2, 20.0, 0)}, {});
  driveOn(propagation, 1, 4);
  propagation.endSubmap(SubmapId(4), originOf(4), {makeLandmark(1, 5.0, 4)}, {});
  const std::vector<HypothesisLandmark> near = propagation.beginSubmap(SubmapId(5), originOf(2));
  ASSERT_EQ(near.size(), 2u);
  EXPECT_EQ(near[0]->id, 1u);
  EXPECT_NEAR(near[0]->position.mean_m.x(), 2.0 * kLength_m + 5.0, 1e-12);
  EXPECT_EQ(near[0]->last_submap.index(), 4U);
  EXPECT_EQ(near[1]->id, 2u);
}

LandmarkPropagation restored(LandmarkPropagation& saved) {
  StateArchive writing;
  saved.transfer(writing);
  const std::string reading_bytes = writing.written();
  StateArchive reading(reading_bytes);
  LandmarkPropagation result = makePropagation();
  result.transfer(reading);
  return result;
}

TEST(LandmarkPropagationTest, RestingLandmarksOutliveTheProgram) {
  LandmarkPropagation propagation = makePropagation();
  propagation.endSubmap(SubmapId(0), originOf(0), {makeLandmark(1, 0.0, 0), makeLandmark(2, 60.0, 0)}, {});
  driveOn(propagation, 1, 4);
  LandmarkPropagation again = restored(propagation);
  again.endSubmap(SubmapId(4), originOf(4), {}, {});
  const std::vector<HypothesisLandmark> near = again.beginSubmap(SubmapId(5), originOf(1));
  ASSERT_EQ(near.size(), 1u);
  EXPECT_EQ(near[0]->id, 1u);
  EXPECT_NEAR(near[0]->position.mean_m.x(), -kLength_m, 1e-12);
}

TEST(LandmarkPropagationTest, LandmarksBetweenSubmapsOutliveTheProgram) {
  LandmarkPropagation propagation = makePropagation();
  MapHypothesis best;
  best.offset.mean = {0.5, 0.0, 0.0, 0.0};
  best.offset.cov.diagonal().setConstant(0.01);
  propagation.endSubmap(SubmapId(1), originOf(1), {makeLandmark(1, 10.0, 1)}, best);
  LandmarkPropagation again = restored(propagation);
  const std::vector<HypothesisLandmark> expected = propagation.beginSubmap(SubmapId(2), originOf(2));
  const std::vector<HypothesisLandmark> near = again.beginSubmap(SubmapId(2), originOf(2));
  ASSERT_EQ(near.size(), 1u);
  EXPECT_NEAR(near[0]->position.mean_m.x(), -20.5, 1e-12);
  EXPECT_EQ(near[0]->position.mean_m, expected[0]->position.mean_m);
  EXPECT_EQ(near[0]->position.cov_m2, expected[0]->position.cov_m2);
  EXPECT_EQ(near[0].existence.log_odds, expected[0].existence.log_odds);
}

}  // namespace
}  // namespace semantic_mht_slam
