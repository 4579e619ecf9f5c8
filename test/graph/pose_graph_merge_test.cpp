/// \file
/// Landmarks of a `PoseGraph` that turn out to be one, and landmarks that keep their number over a whole drive.

#include <limits>
#include <set>
#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/graph/pose_graph.h"

#include "drive_through.h"

namespace semantic_mht_slam {
namespace {

/// A drive through a few streets, on which the same landmarks are met again and again.
SimulatedDrive simulate(std::uint64_t seed, int submaps) {
  SimulatedDriveOptions options = smallTown(submaps);
  options.loop_prob = 0.5;
  options.wrong_loop_prob = 0.0;
  Rng rng(seed);
  return simulateDrive(options, rng);
}

constexpr std::int64_t kAlias = 1000000;

/// The drive as somebody sees it who does not recognise a landmark from `submap` on: there all numbers are new.
SimulatedDrive withNewNumbersFrom(SimulatedDrive drive, int submap) {
  for (int i = submap; i < static_cast<int>(drive.steps.size()); ++i) {
    for (LandmarkSighting& sighting : drive.steps[i].node.sightings) sighting.landmark += kAlias;
  }
  return drive;
}

std::set<std::int64_t> numbersSeen(const SimulatedDrive& drive, int first, int end) {
  std::set<std::int64_t> numbers;
  for (int i = first; i < end; ++i) {
    for (const LandmarkSighting& sighting : drive.steps[i].node.sightings) numbers.insert(sighting.landmark);
  }
  return numbers;
}

/// Largest distance between the poses of two graphs, metres.
double largestDistance(const PoseGraph& a, const PoseGraph& b) {
  double largest_m = 0.0;
  for (int i = 0; i < a.submaps(); ++i) {
    largest_m = std::max(largest_m, (a.pose(i).translation_m - b.pose(i).translation_m).norm());
  }
  return largest_m;
}

/// Merges the landmarks that carry two numbers, from the older number to the newer one or the other way round.
int mergeAll(PoseGraph& graph, const SimulatedDrive& drive, int renamed_from, int end, bool newer_survives) {
  const std::set<std::int64_t> before = numbersSeen(drive, 0, renamed_from);
  int merged = 0;
  for (const std::int64_t number : numbersSeen(drive, renamed_from, end)) {
    if (before.count(number) == 0) continue;
    const std::int64_t renamed = number + kAlias;
    newer_survives ? graph.mergeLandmarks(number, renamed) : graph.mergeLandmarks(renamed, number);
    ++merged;
  }
  return merged;
}

class MergedLandmarksTest : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MergedLandmarksTest, FullSolutionEqualsThatOfOneLandmarkFromTheBeginning) {
  constexpr int kSubmaps = 200;
  const SimulatedDrive drive = simulate(GetParam(), kSubmaps);
  Driven one = driveThrough(drive);
  ASSERT_EQ(one.graph.optimizeFully().failure, "");
  for (const bool newer_survives : {false, true}) {
    Driven two = driveThrough(withNewNumbersFrom(drive, 100));
    ASSERT_EQ(two.failures, "");
    two.graph.optimizeFully();
    const double apart_m = largestDistance(one.graph, two.graph);
    ASSERT_GT(mergeAll(two.graph, drive, 100, kSubmaps, newer_survives), 20);
    ASSERT_EQ(two.graph.optimizeFully().failure, "");
    EXPECT_NEAR(two.graph.cost(), one.graph.cost(), 1e-3 * one.graph.cost());
    EXPECT_LT(largestDistance(one.graph, two.graph), 0.02 + 0.05 * apart_m);
    const std::int64_t number = *numbersSeen(drive, 100, kSubmaps).begin();
    EXPECT_LT((*two.graph.landmark(number) - *one.graph.landmark(number)).norm(), 0.05);
  }
}

TEST_P(MergedLandmarksTest, NumberThatWasGivenUpMeansTheSurvivorInLaterSubmaps) {
  constexpr int kSubmaps = 200;
  constexpr int kMerge = 130;
  const SimulatedDrive drive = simulate(GetParam(), kSubmaps);
  Driven one = driveThrough(drive);
  ASSERT_EQ(one.graph.optimizeFully().failure, "");
  const SimulatedDrive renamed = withNewNumbersFrom(drive, 100);
  const std::set<std::int64_t> before = numbersSeen(drive, 0, 100);
  PoseGraph two;
  std::set<std::int64_t> merged;
  for (int i = 0; i < kSubmaps; ++i) {
    two.addSubmap(renamed.steps[i].node);
    for (const LoopConstraint& loop : renamed.steps[i].loops) two.addLoopClosure(loop);
    for (const LandmarkSighting& sighting : drive.steps[i].node.sightings) {
      if (i < kMerge || before.count(sighting.landmark) == 0 || !merged.insert(sighting.landmark).second) continue;
      two.mergeLandmarks(sighting.landmark + kAlias, sighting.landmark);
    }
    ASSERT_EQ(two.optimize().failure, "") << i;
  }
  mergeAll(two, drive, 100, kMerge, false);
  ASSERT_EQ(two.optimizeFully().failure, "");
  EXPECT_NEAR(two.cost(), one.graph.cost(), 1e-3 * one.graph.cost());
  EXPECT_LT(largestDistance(one.graph, two), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MergedLandmarksTest, testing::Values(41, 42));

/// Straight out, back beside the way out; eight landmarks at the start, seen from the first two and the last two
/// submaps.
struct OutAndBack {
  static constexpr int kHalf = 100;
  static constexpr double kStep_m = 6.0;
  static constexpr double kDrift_m = 5.0;  // that odometry has gathered at the end
  static constexpr int kLandmarks = 8;

  static Pose truth(int i) {
    const double along_m = kStep_m * (i < kHalf ? i : 2 * kHalf - 1 - i);
    return {expRotation({0.0, 0.0, i < kHalf ? 0.0 : M_PI}), {along_m, i < kHalf ? 0.0 : 3.0, 0.0}};
  }

  static Eigen::Vector3d landmarkAt(int k) { return {3.0 * k, k % 2 == 0 ? 6.0 : -6.0, 0.5 * k}; }

  static SubmapNode submap(int i, bool renames) {
    SubmapNode node;
    node.T_previous_submap = i == 0 ? truth(0) : truth(i - 1).inverse() * truth(i);
    node.T_previous_submap.translation_m.y() += i == 0 ? 0.0 : kDrift_m / kHalf * (i < kHalf ? 0.0 : 1.0);
    node.odometry_cov = PoseCov::Identity() * 0.01;
    node.odometry_cov.diagonal().tail<3>().setConstant(1e-6);
    const bool is_end = i >= 2 * kHalf - 2;
    for (int k = 0; k < kLandmarks && (i < 2 || is_end); ++k) {
      node.sightings.push_back({k + (renames && is_end ? kLandmarks : 0), truth(i).inverse() * landmarkAt(k),
                                0.01 * Eigen::Matrix3d::Identity()});
    }
    return node;
  }
};

TEST(MergeWakesUpTest, NextCallBringsBothPlacesTogetherAsALoopClosureWould) {
  PoseGraphConfig config;
  config.whole_submaps = 0;  // only what happens on the skeleton and around the places
  PoseGraph graph(config);
  const int count = 2 * OutAndBack::kHalf;
  for (int i = 0; i < count; ++i) {
    graph.addSubmap(OutAndBack::submap(i, true));
    graph.optimize();
  }
  const auto error_m = [&] {
    return (graph.pose(count - 1).translation_m - OutAndBack::truth(count - 1).translation_m).norm();
  };
  ASSERT_GT(error_m(), 0.9 * OutAndBack::kDrift_m);
  EXPECT_FALSE(graph.optimize().moved_everything);
  for (int k = 0; k < OutAndBack::kLandmarks; ++k) graph.mergeLandmarks(k + OutAndBack::kLandmarks, k);
  const PoseGraphUpdate update = graph.optimize();
  EXPECT_EQ(update.failure, "");
  EXPECT_TRUE(update.moved_everything);
  EXPECT_LT(error_m(), 0.1);
  EXPECT_EQ(*graph.landmark(3), *graph.landmark(3 + OutAndBack::kLandmarks));
  EXPECT_LT((*graph.landmark(3) - OutAndBack::landmarkAt(3)).norm(), 0.1);
  EXPECT_FALSE(graph.optimize().moved_everything);
}

TEST(MergeWakesUpTest, LandmarksThatKeepTheirNumberBringBothPlacesTogetherToo) {
  PoseGraphConfig config;
  config.whole_submaps = 0;
  PoseGraph graph(config);
  const int count = 2 * OutAndBack::kHalf;
  for (int i = 0; i < count; ++i) {
    graph.addSubmap(OutAndBack::submap(i, false));
    ASSERT_EQ(graph.optimize().failure, "");
  }
  EXPECT_LT((graph.pose(count - 1).translation_m - OutAndBack::truth(count - 1).translation_m).norm(), 0.1);
}

TEST(MergeInputTest, UnknownOrEqualNumbersAreRefusedAndNothingChanges) {
  PoseGraph graph;
  SubmapNode node;
  node.odometry_cov = 0.01 * PoseCov::Identity();
  node.sightings = {{1, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()},
                    {2, {1.2, 0.0, 0.0}, Eigen::Matrix3d::Identity()}};
  graph.addSubmap(node);
  EXPECT_THROW(graph.mergeLandmarks(1, 1), std::invalid_argument);
  EXPECT_THROW(graph.mergeLandmarks(1, 3), std::invalid_argument);
  EXPECT_THROW(graph.mergeLandmarks(3, 1), std::invalid_argument);
  EXPECT_DOUBLE_EQ(graph.landmark(1)->x(), 1.0);
  EXPECT_DOUBLE_EQ(graph.landmark(2)->x(), 1.2);
  EXPECT_FALSE(graph.landmark(3).has_value());
}

TEST(MergeInputTest, TwoSightingsOfOneSubmapAreWeighedTogether) {
  PoseGraph graph;
  SubmapNode node;
  node.sightings = {{1, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()},
                    {2, {1.2, 0.0, 0.0}, Eigen::Matrix3d::Identity()}};
  graph.addSubmap(node);
  graph.mergeLandmarks(1, 2);
  graph.mergeLandmarks(2, 1);  // are one already
  ASSERT_EQ(graph.optimizeFully().failure, "");
  EXPECT_NEAR(graph.landmark(1)->x(), 1.1, 1e-3);
  EXPECT_EQ(*graph.landmark(1), *graph.landmark(2));
  EXPECT_NEAR((*graph.landmarkCovariance(1))(0, 0), 0.5, 0.01);  // the loss takes a little weight
}

}  // namespace
}  // namespace semantic_mht_slam
