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
SimulatedDrive simulate(std::uint64_t seed, int nodes) {
  SimulatedDriveOptions options = smallTown(nodes);
  options.loop_prob = 0.5;
  options.wrong_loop_prob = 0.0;
  Rng rng(seed);
  return simulateDrive(options, rng);
}

constexpr std::int64_t kAlias = 1000000;

/// The drive as somebody sees it who does not recognise a landmark from `node` on: there all numbers are new.
SimulatedDrive withNewNumbersFrom(SimulatedDrive drive, int node) {
  for (int i = node; i < static_cast<int>(drive.steps.size()); ++i) {
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
  for (int i = 0; i < a.nodes(); ++i) {
    largest_m = std::max(largest_m, (a.pose(i).translation_m - b.pose(i).translation_m).norm());
  }
  return largest_m;
}

using Groups = std::vector<std::vector<std::int64_t>>;

/// The landmarks that carry two numbers.
Groups pairsOf(const SimulatedDrive& drive, int renamed_from, int end) {
  const std::set<std::int64_t> before = numbersSeen(drive, 0, renamed_from);
  Groups pairs;
  for (const std::int64_t number : numbersSeen(drive, renamed_from, end)) {
    if (before.count(number) > 0) pairs.push_back({number, number + kAlias});
  }
  return pairs;
}

class MergedLandmarksTest : public testing::TestWithParam<std::uint64_t> {};

TEST_P(MergedLandmarksTest, FullSolutionEqualsThatOfOneLandmarkFromTheBeginning) {
  constexpr int kNodes = 200;
  const SimulatedDrive drive = simulate(GetParam(), kNodes);
  Driven one = driveThrough(drive);
  ASSERT_EQ(one.graph.optimizeFully().failure, "");
  for (const bool is_split_between : {false, true}) {
    Driven two = driveThrough(withNewNumbersFrom(drive, 100));
    ASSERT_EQ(two.failures, "");
    ASSERT_EQ(two.graph.optimizeFully().failure, "");
    const double apart_m = largestDistance(one.graph, two.graph);
    const Groups pairs = pairsOf(drive, 100, kNodes);
    ASSERT_GT(pairs.size(), 20U);
    two.graph.regroup(pairs);
    if (is_split_between) {
      ASSERT_EQ(two.graph.optimize().failure, "");
      Groups single;
      for (const auto& pair : pairs) single.insert(single.end(), {{pair[0]}, {pair[1]}});
      two.graph.regroup(single);
      ASSERT_EQ(two.graph.optimize().failure, "");
      two.graph.regroup(pairs);
    }
    ASSERT_EQ(two.graph.optimizeFully().failure, "");
    EXPECT_NEAR(two.graph.cost(), one.graph.cost(), 1e-3 * one.graph.cost());
    EXPECT_LT(largestDistance(one.graph, two.graph), 0.02 + 0.05 * apart_m);
    const std::int64_t number = *numbersSeen(drive, 100, kNodes).begin();
    EXPECT_LT((*two.graph.landmark(number) - *one.graph.landmark(number)).norm(), 0.05);
  }
}

TEST_P(MergedLandmarksTest, NumberThatWasGivenUpMeansTheSurvivorInLaterNodes) {
  constexpr int kNodes = 200;
  constexpr int kMerge = 130;
  const SimulatedDrive drive = simulate(GetParam(), kNodes);
  Driven one = driveThrough(drive);
  ASSERT_EQ(one.graph.optimizeFully().failure, "");
  const SimulatedDrive renamed = withNewNumbersFrom(drive, 100);
  const std::set<std::int64_t> before = numbersSeen(drive, 0, 100);
  PoseGraph two;
  std::set<std::int64_t> merged;
  for (int i = 0; i < kNodes; ++i) {
    two.addNode(renamed.steps[i].node);
    for (const LoopConstraint& loop : renamed.steps[i].loops) two.addLoopClosure(loop);
    for (const LandmarkSighting& sighting : drive.steps[i].node.sightings) {
      if (i < kMerge || before.count(sighting.landmark) == 0 || !merged.insert(sighting.landmark).second) continue;
      two.regroup({{sighting.landmark, sighting.landmark + kAlias}});
    }
    ASSERT_EQ(two.optimize().failure, "") << i;
  }
  two.regroup(pairsOf(drive, 100, kMerge));
  ASSERT_EQ(two.optimizeFully().failure, "");
  EXPECT_NEAR(two.cost(), one.graph.cost(), 1e-3 * one.graph.cost());
  EXPECT_LT(largestDistance(one.graph, two), 0.05);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MergedLandmarksTest, testing::Values(41, 42));

/// Straight out, back beside the way out; eight landmarks at the start, seen from the first two and the last two
/// nodes.
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

  static PoseNode node(int i, bool renames) {
    PoseNode node;
    node.T_previous_node = i == 0 ? truth(0) : truth(i - 1).inverse() * truth(i);
    node.T_previous_node.translation_m.y() += i == 0 ? 0.0 : kDrift_m / kHalf * (i < kHalf ? 0.0 : 1.0);
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
  config.whole_nodes = 0;  // only what happens on the skeleton and around the places
  PoseGraph graph(config);
  const int count = 2 * OutAndBack::kHalf;
  for (int i = 0; i < count; ++i) {
    graph.addNode(OutAndBack::node(i, true));
    ASSERT_EQ(graph.optimize().failure, "");
  }
  const auto error_m = [&] {
    return (graph.pose(count - 1).translation_m - OutAndBack::truth(count - 1).translation_m).norm();
  };
  ASSERT_GT(error_m(), 0.9 * OutAndBack::kDrift_m);
  EXPECT_FALSE(graph.optimize().moved_everything);
  Groups pairs;
  Groups single;
  for (int k = 0; k < OutAndBack::kLandmarks; ++k) {
    pairs.push_back({k, k + OutAndBack::kLandmarks});
    single.insert(single.end(), {{k}, {k + OutAndBack::kLandmarks}});
  }
  graph.regroup(pairs);
  const PoseGraphUpdate update = graph.optimize();
  EXPECT_EQ(update.failure, "");
  EXPECT_TRUE(update.moved_everything);
  EXPECT_LT(error_m(), 0.1);
  EXPECT_EQ(*graph.landmark(3), *graph.landmark(3 + OutAndBack::kLandmarks));
  EXPECT_LT((*graph.landmark(3) - OutAndBack::landmarkAt(3)).norm(), 0.1);
  EXPECT_FALSE(graph.optimize().moved_everything);

  graph.regroup(single);
  const PoseGraphUpdate split = graph.optimize();
  EXPECT_EQ(split.failure, "");
  EXPECT_TRUE(split.moved_everything);
  EXPECT_GT(error_m(), 0.9 * OutAndBack::kDrift_m) << "nothing holds the two ends together any more";
  EXPECT_GT((*graph.landmark(3) - *graph.landmark(3 + OutAndBack::kLandmarks)).norm(), 0.8 * OutAndBack::kDrift_m);
  EXPECT_FALSE(graph.optimize().moved_everything);
}

TEST(MergeWakesUpTest, LandmarksThatKeepTheirNumberBringBothPlacesTogetherToo) {
  PoseGraphConfig config;
  config.whole_nodes = 0;
  PoseGraph graph(config);
  const int count = 2 * OutAndBack::kHalf;
  for (int i = 0; i < count; ++i) {
    graph.addNode(OutAndBack::node(i, false));
    ASSERT_EQ(graph.optimize().failure, "");
  }
  EXPECT_LT((graph.pose(count - 1).translation_m - OutAndBack::truth(count - 1).translation_m).norm(), 0.1);
}

TEST(MergeInputTest, GroupsThatMakeNoSenseAreRefusedAndNothingChanges) {
  PoseGraph graph;
  PoseNode node;
  node.odometry_cov = 0.01 * PoseCov::Identity();
  node.sightings = {{1, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()},
                    {2, {1.2, 0.0, 0.0}, Eigen::Matrix3d::Identity()}};
  graph.addNode(node);
  EXPECT_THROW(graph.regroup({{1, 1}}), std::invalid_argument);
  EXPECT_THROW(graph.regroup({{1, 3}, {2, 3}}), std::invalid_argument);
  EXPECT_THROW(graph.regroup({{}}), std::invalid_argument);
  EXPECT_DOUBLE_EQ(graph.landmark(1)->x(), 1.0);
  EXPECT_DOUBLE_EQ(graph.landmark(2)->x(), 1.2);
  EXPECT_FALSE(graph.landmark(3).has_value());
  graph.regroup({{1, 2}});
  EXPECT_THROW(graph.regroup({{1}}), std::invalid_argument) << "and what becomes of 2?";
  EXPECT_EQ(*graph.landmark(1), *graph.landmark(2));
}

TEST(MergeInputTest, NumbersThatNobodySawYetAreRemembered) {
  PoseGraph graph;
  graph.regroup({{4, 7}});
  PoseNode node;
  node.sightings = {{7, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()}};
  graph.addNode(node);
  ASSERT_TRUE(graph.landmark(4).has_value());
  EXPECT_EQ(*graph.landmark(4), *graph.landmark(7));
  graph.regroup({{4}, {7}});
  EXPECT_FALSE(graph.landmark(4).has_value());
  EXPECT_DOUBLE_EQ(graph.landmark(7)->x(), 1.0);
}

TEST(MergeInputTest, TwoSightingsOfOneNodeAreWeighedTogether) {
  PoseGraph graph;
  PoseNode node;
  node.sightings = {{1, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()},
                    {2, {1.2, 0.0, 0.0}, Eigen::Matrix3d::Identity()}};
  graph.addNode(node);
  graph.regroup({{1, 2}});
  graph.regroup({{2, 1}});  // are one already
  ASSERT_EQ(graph.optimizeFully().failure, "");
  EXPECT_NEAR(graph.landmark(1)->x(), 1.1, 1e-3);
  EXPECT_EQ(*graph.landmark(1), *graph.landmark(2));
  EXPECT_NEAR(graph.marginals()->landmarks.at(graph.keptNumber(1))(0, 0), 0.5, 0.01);  // the loss takes a little weight
}

}  // namespace
}  // namespace semantic_mht_slam
