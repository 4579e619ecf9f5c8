/// \file
/// Positions in a frame beside the world, whose place is estimated, too: satellites.

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/graph/pose_graph.h"

#include "drive_through.h"

namespace semantic_mht_slam {
namespace {

constexpr double kNoise_m = 1.0;

const Pose kT_outer_world{expRotation({0.0, 0.0, 2.1}), {400.0, -150.0, 30.0}};

SimulatedDrive driftingDrive(std::uint64_t seed, int nodes) {
  SimulatedDriveOptions options;
  options.nodes = nodes;
  options.loop_prob = 0.0;
  options.wrong_loop_prob = 0.0;
  options.odometry_m = 0.4;
  options.odometry_rad = 0.02;
  options.resighted_landmarks = false;
  Rng rng(seed);
  SimulatedDrive drive = simulateDrive(options, rng);
  for (SimulatedDrive::Step& step : drive.steps) step.node.sightings.clear();
  return drive;
}

const Eigen::Vector3d kAntenna_m(-0.8, 0.3, 1.5);

OuterPosition positionOf(const Pose& T_world_node, int node, Rng& rng, double noise_m = kNoise_m) {
  OuterPosition position;
  position.node = node;
  position.in_node_m = kAntenna_m;
  position.measured_m = kT_outer_world * (T_world_node * kAntenna_m);
  for (int i = 0; i < 3; ++i) position.measured_m[i] += rng.normal(0.0, noise_m);
  position.cov_m2 = noise_m * noise_m * Eigen::Matrix3d::Identity();
  return position;
}

/// Every `outlier`-th position is wrong by 30 m or more; 0: none.
PoseGraph drivenWithPositions(const SimulatedDrive& drive, int outlier = 0, bool has_positions = true) {
  PoseGraph graph;
  Rng rng(11);
  int node = 0;
  for (const SimulatedDrive::Step& step : drive.steps) {
    graph.addNode(step.node);
    OuterPosition position = positionOf(step.T_world_node, node, rng);
    if (outlier > 0 && node % outlier == outlier - 1) position.measured_m += Eigen::Vector3d(25.0, -20.0, 10.0);
    if (has_positions) graph.addPosition(position);
    EXPECT_EQ(graph.optimize().failure, "");
    ++node;
  }
  return graph;
}

double largestStep(const PoseGraph& a, const PoseGraph& b) {
  double largest = 0.0;
  for (int i = 0; i < a.nodes(); ++i) {
    largest = std::max(largest, (a.pose(i).translation_m - b.pose(i).translation_m).norm());
  }
  return largest;
}

TEST(OuterPositionsTest, ADriftingDriveFollowsItsPositionsAndTheFirstNodeStays) {
  const SimulatedDrive drive = driftingDrive(1, 400);
  PoseGraph graph = drivenWithPositions(drive);
  const double without_m = alignedRmse(deadReckoning(drive), drive);
  EXPECT_LT(alignedRmse(graph.poses(), drive), 0.1 * without_m);
  ASSERT_EQ(graph.optimizeFully().failure, "");
  EXPECT_LT(alignedRmse(graph.poses(), drive), 0.05 * without_m);
  EXPECT_LT(alignedRmse(graph.poses(), drive), 1.2 * kNoise_m);
  EXPECT_EQ(graph.pose(0).translation_m, drive.steps[0].node.T_previous_node.translation_m);
  ASSERT_TRUE(graph.T_outer_world());
  const Pose error = kT_outer_world.inverse() * *graph.T_outer_world();
  EXPECT_LT(error.translation_m.norm(), 3.0 * kNoise_m);
  EXPECT_LT(angularDistance(error.rotation, Eigen::Quaterniond::Identity()), 0.05);
}

TEST(OuterPositionsTest, OnePositionInTenWrongBy30MetresDoesNoHarm) {
  const SimulatedDrive drive = driftingDrive(2, 400);
  PoseGraph good = drivenWithPositions(drive);
  PoseGraph bad = drivenWithPositions(drive, 10);
  ASSERT_EQ(good.optimizeFully().failure, "");
  ASSERT_EQ(bad.optimizeFully().failure, "");
  EXPECT_LT(alignedRmse(bad.poses(), drive), 1.2 * alignedRmse(good.poses(), drive) + 0.1);
}

TEST(OuterPositionsTest, ARowOfPositionsWrongInTheSameWayDoesNotBendTheMap) {
  const SimulatedDrive drive = driftingDrive(3, 200);
  PoseGraph good;
  PoseGraph bad;
  Rng rng(5);
  for (int node = 0; node < 200; ++node) {
    const SimulatedDrive::Step& step = drive.steps[static_cast<std::size_t>(node)];
    OuterPosition position = positionOf(step.T_world_node, node, rng);
    for (PoseGraph* graph : {&good, &bad}) {
      graph->addNode(step.node);
      const bool is_wrong = graph == &bad && node >= 100 && node < 110;
      if (is_wrong) position.measured_m += Eigen::Vector3d(50.0, 0.0, 0.0);
      graph->addPosition(position);
      ASSERT_EQ(graph->optimize().failure, "");
    }
  }
  ASSERT_EQ(good.optimizeFully().failure, "");
  ASSERT_EQ(bad.optimizeFully().failure, "");
  EXPECT_LT(largestStep(good, bad), 4.0);
}

/// Nodes at these places, all with exact odometry; a position at each.
PoseGraph standingAt(const std::vector<Pose>& places, double noise_m) {
  PoseGraph graph;
  Rng rng(7);
  for (std::size_t i = 0; i < places.size(); ++i) {
    PoseNode node;
    node.T_previous_node = i == 0 ? places[0] : places[i - 1].inverse() * places[i];
    node.odometry_cov = simulated_drive_detail::diagonalCov(0.02, 0.001);
    graph.addNode(node);
    graph.addPosition(positionOf(places[i], static_cast<int>(i), rng, noise_m));
    EXPECT_EQ(graph.optimize().failure, "");
  }
  return graph;
}

std::vector<Pose> straightLine(int count, double step_m) {
  std::vector<Pose> places;
  for (int i = 0; i < count; ++i) places.push_back({Eigen::Quaterniond::Identity(), {i * step_m, 0.0, 0.0}});
  return places;
}

TEST(OuterPositionsTest, AStraightLineDeterminesTheFrameOnceItIsLongForItsNoise) {
  EXPECT_FALSE(standingAt(straightLine(5, 10.0), kNoise_m).T_outer_world()) << "too few";
  EXPECT_FALSE(standingAt(straightLine(20, 0.2), kNoise_m).T_outer_world()) << "too short";
  EXPECT_FALSE(standingAt(straightLine(20, 5.0), 30.0 * kNoise_m).T_outer_world()) << "too noisy";
  const PoseGraph graph = standingAt(straightLine(60, 5.0), kNoise_m);
  ASSERT_TRUE(graph.T_outer_world());
  const Eigen::Vector3d ahead =
      kT_outer_world.inverse().rotation * (graph.T_outer_world()->rotation * Eigen::Vector3d::UnitX());
  EXPECT_LT(std::abs(std::atan2(ahead.y(), ahead.x())), 0.03);
}

TEST(OuterPositionsTest, StandingStillDeterminesNothingAndChangesNothing) {
  const PoseGraph graph = standingAt(straightLine(200, 0.0), kNoise_m);
  EXPECT_FALSE(graph.T_outer_world());
  for (int i = 0; i < graph.nodes(); ++i) EXPECT_LT(graph.pose(i).translation_m.norm(), 1e-9);
}

TEST(OuterPositionsTest, PositionsOfWhichMostContradictEachOtherHaveNoEffect) {
  const SimulatedDrive drive = driftingDrive(4, 60);
  PoseGraph graph;
  const PoseGraph without = drivenWithPositions(drive, 0, false);
  Rng rng(3);
  for (int node = 0; node < 60; ++node) {
    graph.addNode(drive.steps[static_cast<std::size_t>(node)].node);
    OuterPosition position = positionOf(Pose::identity(), node, rng);
    position.measured_m = {rng.uniform(-2000.0, 2000.0), rng.uniform(-2000.0, 2000.0), 0.0};
    graph.addPosition(position);
    ASSERT_EQ(graph.optimize().failure, "");
  }
  EXPECT_FALSE(graph.T_outer_world());
  EXPECT_EQ(largestStep(graph, without), 0.0);
}

TEST(OuterPositionsTest, CovariancesAreSmallerFarFromTheStartAndHoldWhatTheErrorsAre) {
  const SimulatedDrive drive = driftingDrive(5, 200);
  PoseGraph with = drivenWithPositions(drive);
  PoseGraph without = drivenWithPositions(drive, 0, false);
  ASSERT_EQ(with.optimizeFully().failure, "");
  ASSERT_EQ(without.optimizeFully().failure, "");
  const auto better = with.marginals();
  const auto worse = without.marginals();
  const auto coarse = with.coarseMarginals();
  ASSERT_TRUE(better && worse && coarse);
  const double stddev_m = std::sqrt(better->poses.back().topLeftCorner<2, 2>().trace());
  EXPECT_LT(stddev_m, 0.3 * std::sqrt(worse->poses.back().topLeftCorner<2, 2>().trace()));
  const double error_m = (with.pose(199).translation_m - drive.steps[199].T_world_node.translation_m).head<2>().norm();
  EXPECT_LT(error_m, 4.0 * stddev_m);
  const double coarse_m = std::sqrt(coarse->back().total().topLeftCorner<2, 2>().trace());
  EXPECT_NEAR(coarse_m, stddev_m, 0.5 * stddev_m);
}

TEST(OuterPositionsTest, AGraphThatIsReadGoesOnToTheLastBit) {
  const SimulatedDrive drive = driftingDrive(6, 260);
  PoseGraph graph;
  Rng rng(9);
  const auto drive_on = [&](PoseGraph& driven, int node, const OuterPosition& position) {
    driven.addNode(drive.steps[static_cast<std::size_t>(node)].node);
    driven.addPosition(position);
    ASSERT_EQ(driven.optimize().failure, "");
  };
  for (int node = 0; node < 200; ++node) {
    drive_on(graph, node, positionOf(drive.steps[static_cast<std::size_t>(node)].T_world_node, node, rng));
  }
  StateArchive writer;
  graph.transfer(writer, {});
  graph.transferPositions(writer);
  const std::string bytes = writer.written();
  PoseGraph again;
  StateArchive reader(bytes);
  again.transfer(reader, {});
  again.transferPositions(reader);
  reader.requireEnd();
  EXPECT_EQ(again.positions(), 200U);
  for (int node = 200; node < 260; ++node) {
    const OuterPosition position = positionOf(drive.steps[static_cast<std::size_t>(node)].T_world_node, node, rng);
    drive_on(graph, node, position);
    drive_on(again, node, position);
  }
  EXPECT_EQ(largestStep(graph, again), 0.0);
  EXPECT_EQ(graph.T_outer_world()->translation_m, again.T_outer_world()->translation_m);
}

TEST(OuterPositionsTest, WrongInputIsRefused) {
  PoseGraph graph;
  graph.addNode({});
  OuterPosition position;
  position.node = 1;
  EXPECT_THROW(graph.addPosition(position), std::invalid_argument);
  position.node = 0;
  position.cov_m2.setZero();
  EXPECT_THROW(graph.addPosition(position), std::invalid_argument);
  position.cov_m2.setIdentity();
  position.measured_m.x() = std::nan("");
  EXPECT_THROW(graph.addPosition(position), std::invalid_argument);
  EXPECT_EQ(graph.positions(), 0U);
}

}  // namespace
}  // namespace semantic_mht_slam
