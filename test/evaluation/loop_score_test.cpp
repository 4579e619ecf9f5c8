#include "semantic_mht_slam/evaluation/loop_score.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "semantic_mht_slam/io/trajectory_file.h"

namespace semantic_mht_slam {
namespace {

/// Out along x for 150 frames, five metres a frame, and back on the same road with the opposite heading.
std::vector<Pose> outAndBack() {
  std::vector<Pose> poses;
  for (int i = 0; i < 150; ++i) poses.push_back({Eigen::Quaterniond::Identity(), {5.0 * i, 0.0, 0.0}});
  for (int i = 149; i >= 0; --i) poses.push_back({Eigen::Quaterniond(0.0, 0.0, 0.0, 1.0), {5.0 * i, 0.0, 0.0}});
  return poses;
}

TEST(ClosureScoreTest, CountsTheBlocksThatComeBackAfterTwoHundredFrames) {
  // frame 150 + k stands where frame 149 - k stood: 2 k + 1 > 200 holds for k >= 100, frames 250 to 299
  const ClosureScore score = closureScore(outAndBack(), {});
  EXPECT_EQ(score.revisited_blocks, 5);
  EXPECT_EQ(score.covered_blocks, 0);
  EXPECT_EQ(score.recall, 0.0);
  EXPECT_EQ(score.precision, 0.0);
}

TEST(ClosureScoreTest, AClosureIsRightWithinTwoMetresInTheMatchFrame) {
  // frame 260 stands at 195 m, frame 40 at 200 m
  const ClosureScore right = closureScore(outAndBack(), {{260, 40, true, {-5.0, 1.9, 0.0}}});
  EXPECT_EQ(right.accepted, 1);
  EXPECT_EQ(right.wrong, 0);
  EXPECT_EQ(right.precision, 1.0);
  const ClosureScore wrong = closureScore(outAndBack(), {{260, 40, true, {-5.0, 2.1, 0.0}}});
  EXPECT_EQ(wrong.wrong, 1);
  EXPECT_EQ(wrong.precision, 0.0);
  // seen from frame 260, which looks back, frame 40 lies behind
  EXPECT_EQ(closureScore(outAndBack(), {{40, 260, true, {-5.0, 0.0, 0.0}}}).wrong, 0);
  EXPECT_EQ(closureScore(outAndBack(), {{40, 260, true, {5.0, 0.0, 0.0}}}).wrong, 1);
}

TEST(ClosureScoreTest, ARightClosureCoversTenBlocksAroundIt) {
  const auto covered = [](std::int64_t query) {
    const std::vector<Pose> poses(4000, Pose::identity());  // every block from frame 201 on is revisited
    return closureScore(poses, {{query, 0, true, Eigen::Vector3d::Zero()}}).covered_blocks;
  };
  EXPECT_EQ(covered(2000), 21);
  EXPECT_EQ(covered(200), 11);  // blocks 20 to 30
}

TEST(ClosureScoreTest, RefusedAndWrongClosuresCoverNothing) {
  const std::vector<Pose> poses = outAndBack();
  EXPECT_EQ(closureScore(poses, {{260, 40, false, {-5.0, 0.0, 0.0}}}).accepted, 0);
  EXPECT_EQ(closureScore(poses, {{260, 40, false, {-5.0, 0.0, 0.0}}}).covered_blocks, 0);
  EXPECT_EQ(closureScore(poses, {{260, 40, true, {-50.0, 0.0, 0.0}}}).covered_blocks, 0);
  EXPECT_EQ(closureScore(poses, {{260, 40, true, {-5.0, 0.0, 0.0}}}).covered_blocks, 5);
}

TEST(ClosureScoreTest, RefusesFramesWithoutAPose) {
  EXPECT_THROW(closureScore(outAndBack(), {{300, 0, true, Eigen::Vector3d::Zero()}}), std::invalid_argument);
  EXPECT_THROW(closureScore(outAndBack(), {{0, -1, true, Eigen::Vector3d::Zero()}}), std::invalid_argument);
  EXPECT_THROW(closureScore(outAndBack(), {{260, 40, true, {std::nan(""), 0.0, 0.0}}}), std::invalid_argument);
}

/// Frames 0, 1, 2 stand together; frame 3 is neither near nor far, frame 4 far.
const std::vector<Eigen::Vector2d> kPlaces = {{0.0, 0.0}, {1.0, 0.0}, {0.0, 2.0}, {10.0, 0.0}, {100.0, 0.0}};

TEST(PairScoreTest, PerfectScoresReachOne) {
  const PairScore score = pairScore(kPlaces, {{0, 1, 0.9}, {0, 4, 0.1}, {0, 2, 0.8}, {1, 4, 0.2}});
  EXPECT_EQ(score.pairs, 4);
  EXPECT_EQ(score.positives, 2);
  EXPECT_DOUBLE_EQ(score.f1_max, 1.0);
  EXPECT_DOUBLE_EQ(score.extended_precision, 1.0);
  EXPECT_DOUBLE_EQ(score.recall_at_p100, 1.0);
}

TEST(PairScoreTest, FollowsTheCurveOfAMixedRanking) {
  // true, false, true, false from the top
  const PairScore score = pairScore(kPlaces, {{0, 1, 4.0}, {0, 4, 3.0}, {0, 2, 2.0}, {1, 4, 1.0}});
  EXPECT_EQ(score.precision, (std::vector<double>{1.0, 0.5, 2.0 / 3.0, 0.5}));
  EXPECT_EQ(score.recall, (std::vector<double>{0.5, 0.5, 1.0, 1.0}));
  EXPECT_DOUBLE_EQ(score.f1_max, 0.8);
  EXPECT_DOUBLE_EQ(score.recall_at_p100, 0.5);
  EXPECT_DOUBLE_EQ(score.extended_precision, 0.75);
}

TEST(PairScoreTest, EqualScoresShareOneThresholdInAnyOrder) {
  const PairScore score = pairScore(kPlaces, {{0, 1, 1.0}, {0, 4, 1.0}});
  const PairScore swapped = pairScore(kPlaces, {{0, 4, 1.0}, {0, 1, 1.0}});
  EXPECT_EQ(score.precision, (std::vector<double>{0.5}));
  EXPECT_EQ(score.recall_at_p100, 0.0);
  EXPECT_DOUBLE_EQ(score.extended_precision, 0.25);
  EXPECT_EQ(swapped.precision, score.precision);
}

TEST(PairScoreTest, LeavesOutPairsThatAreNeitherNearNorFar) {
  EXPECT_EQ(pairScore(kPlaces, {{0, 3, 1.0}, {0, 1, 0.5}}).pairs, 1);
}

TEST(PairScoreTest, HasNoFiguresWithoutATruePair) {
  const PairScore score = pairScore(kPlaces, {{0, 4, 1.0}});
  EXPECT_EQ(score.positives, 0);
  EXPECT_TRUE(std::isnan(score.f1_max));
  EXPECT_TRUE(std::isnan(score.extended_precision));
}

TEST(PairScoreTest, RefusesUnknownFramesAndScoresThatAreNoNumbers) {
  EXPECT_THROW(pairScore(kPlaces, {{0, 5, 1.0}}), std::invalid_argument);
  EXPECT_THROW(pairScore(kPlaces, {{-1, 0, 1.0}}), std::invalid_argument);
  EXPECT_THROW(pairScore(kPlaces, {{0, 1, std::nan("")}}), std::invalid_argument);
}

TEST(ClosureScoreTest, SequenceZeroHasEightyRevisitedBlocks) {
  const char* data = std::getenv("SEMANTIC_MHT_SLAM_DATA");
  if (data == nullptr || *data == '\0') GTEST_SKIP() << "SEMANTIC_MHT_SLAM_DATA names no data folder";
  const std::vector<Pose> poses = readKittiTrajectory(std::string(data) + "/kitti/00/poses.txt");
  EXPECT_EQ(closureScore(poses, {}).revisited_blocks, 80);
}

}  // namespace
}  // namespace semantic_mht_slam
