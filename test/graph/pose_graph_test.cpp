#include "semantic_mht_slam/graph/pose_graph.h"

#include <limits>
#include <stdexcept>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "drive_through.h"

namespace semantic_mht_slam {
namespace {

class PoseGraphTest : public testing::TestWithParam<std::uint64_t> {
 protected:
  SimulatedDrive simulate(const SimulatedDriveOptions& options) const {
    Rng rng(GetParam());
    return simulateDrive(options, rng);
  }
};

TEST_P(PoseGraphTest, OnlineEstimateIsNearlyAsGoodAsTheFullSolution) {
  const SimulatedDrive drive = simulate(smallTown(140));
  Driven driven = driveThrough(drive);
  EXPECT_EQ(driven.failures, "");
  const double online_m = alignedRmse(driven.graph.poses(), drive);
  const double before = driven.graph.cost();
  EXPECT_EQ(driven.graph.optimizeFully().failure, "");
  const double full_m = alignedRmse(driven.graph.poses(), drive);
  EXPECT_LT(driven.graph.cost(), before * 1.001);
  EXPECT_LT(online_m, 1.1 * full_m + 0.05);
  EXPECT_LT(online_m, 0.5 * alignedRmse(deadReckoning(drive), drive));
}

TEST_P(PoseGraphTest, WrongLoopClosuresAreSwitchedOffAndRightOnesAreNot) {
  SimulatedDriveOptions options = smallTown(250);
  options.wrong_loop_prob = 0.3;
  const SimulatedDrive drive = simulate(options);
  const Driven driven = driveThrough(drive);
  int wrong_in = 0;
  int right = 0;
  int right_out = 0;
  for (const LoopDecision& decision : driven.graph.loopDecisions()) {
    const bool is_in = decision.state == LoopState::kAccepted;
    wrong_in += driven.is_wrong[decision.loop] && is_in ? 1 : 0;
    right += driven.is_wrong[decision.loop] ? 0 : 1;
    right_out += !driven.is_wrong[decision.loop] && !is_in ? 1 : 0;
  }
  EXPECT_EQ(wrong_in, 0);
  EXPECT_GT(right, 20);
  EXPECT_LE(right_out, right / 20);
}

TEST_P(PoseGraphTest, SecondRunGivesTheSameBits) {
  const SimulatedDrive drive = simulate(smallTown(80));
  const Driven first = driveThrough(drive);
  const Driven second = driveThrough(drive);
  for (int i = 0; i < first.graph.nodes(); ++i) {
    EXPECT_EQ(first.graph.pose(i).translation_m, second.graph.pose(i).translation_m);
    EXPECT_EQ(first.graph.pose(i).rotation.coeffs(), second.graph.pose(i).rotation.coeffs());
  }
}

TEST_P(PoseGraphTest, ErrorsAreOfTheSizeThatTheCovariancesSay) {
  SimulatedDriveOptions options = smallTown(60);
  options.wrong_loop_prob = 0.0;
  const SimulatedDrive drive = simulate(options);
  Driven driven = driveThrough(drive);
  ASSERT_EQ(driven.graph.optimizeFully().failure, "");
  double sum = 0.0;
  int count = 0;
  const std::optional<GraphMarginals> marginals = driven.graph.marginals();
  ASSERT_TRUE(marginals.has_value());
  for (int i = 10; i < driven.graph.nodes(); i += 10) {
    const PoseCov& cov = marginals->poses[static_cast<std::size_t>(i)];
    const Pose error = driven.graph.pose(i).inverse() * drive.steps[i].T_world_node;
    Eigen::Matrix<double, 6, 1> e;
    e << error.translation_m, logRotation(error.rotation);
    sum += e.dot(cov.ldlt().solve(e));
    ++count;
  }
  // The poses are strongly correlated, so the mean of 5 has the spread of hardly more than one: 6 +- 4 sqrt(12).
  EXPECT_LT(sum / count, 6.0 + 4.0 * std::sqrt(12.0));
  const auto& [id, truth] = *drive.landmarks_m.begin();
  const Eigen::Matrix3d& cov = marginals->landmarks.at(driven.graph.keptNumber(id));
  EXPECT_GT(cov.eigenvalues().real().minCoeff(), 0.0);
  const Eigen::Vector3d error = *driven.graph.landmark(id) - truth;
  EXPECT_LT(error.dot(cov.ldlt().solve(error)), 30.0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PoseGraphTest, testing::Range<std::uint64_t>(1, 6));

PoseNode step(double x_m) {
  PoseNode node;
  node.T_previous_node.translation_m.x() = x_m;
  node.odometry_cov = 0.01 * PoseCov::Identity();
  return node;
}

TEST(PoseGraphPriorTest, PriorPullsAsTheCovariancesSay) {
  PoseGraph graph;
  graph.addNode(step(0.0));
  graph.addNode(step(1.0));
  graph.addPrior(1, Pose{Eigen::Quaterniond::Identity(), {2.0, 0.0, 0.0}}, 0.01 * PoseCov::Identity());
  EXPECT_EQ(graph.optimize().failure, "");
  EXPECT_NEAR(graph.pose(1).translation_m.x(), 1.5, 1e-6);  // halfway between two equally certain values
  EXPECT_EQ(graph.pose(0).translation_m.norm(), 0.0);
  const auto marginals = graph.marginals();
  ASSERT_TRUE(marginals.has_value());
  EXPECT_NEAR(marginals->poses[1](0, 0), 0.005, 1e-9);
  EXPECT_TRUE(marginals->poses[0].isZero());
}

TEST(PoseGraphPriorTest, CovarianceOfOdometryAloneIsWhatWasPutIn) {
  PoseGraph graph;
  graph.addNode(step(0.0));
  PoseNode second = step(1.0);
  second.T_previous_node.rotation = expRotation({0.1, -0.4, 1.0});
  second.odometry_cov.diagonal() << 0.01, 0.02, 0.03, 0.004, 0.005, 0.006;
  second.odometry_cov(0, 4) = second.odometry_cov(4, 0) = 0.003;
  graph.addNode(second);
  ASSERT_EQ(graph.optimize().failure, "");
  const auto marginals = graph.marginals();
  ASSERT_TRUE(marginals.has_value());
  EXPECT_TRUE(marginals->poses[1].isApprox(second.odometry_cov, 1e-9)) << marginals->poses[1];
  const auto coarse = graph.coarseMarginals();
  ASSERT_TRUE(coarse.has_value());
  EXPECT_EQ(coarse->back().node, 1);
  EXPECT_TRUE(coarse->back().total().isApprox(second.odometry_cov, 1e-9));
}

TEST(PoseGraphInputTest, BadInputThrowsAndChangesNothing) {
  PoseGraph graph;
  graph.addNode(step(0.0));
  graph.addNode(step(1.0));
  PoseNode bad = step(std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(graph.addNode(bad), std::invalid_argument);
  bad = step(1.0);
  bad.odometry_cov(2, 2) = -1.0;
  EXPECT_THROW(graph.addNode(bad), std::invalid_argument);
  bad = step(1.0);
  bad.sightings.resize(2);  // the same landmark twice
  EXPECT_THROW(graph.addNode(bad), std::invalid_argument);
  EXPECT_THROW(graph.addLoopClosure({0, 2, Pose{}, PoseCov::Identity()}), std::invalid_argument);
  EXPECT_THROW(graph.addLoopClosure({1, 1, Pose{}, PoseCov::Identity()}), std::invalid_argument);
  EXPECT_THROW(graph.addLoopClosure({1, 0, Pose{}, PoseCov::Zero()}), std::invalid_argument);
  EXPECT_THROW(graph.addPrior(5, Pose{}, PoseCov::Identity()), std::invalid_argument);
  EXPECT_EQ(graph.nodes(), 2);
  PoseGraphConfig config;
  config.chunk_nodes = 0;
  EXPECT_THROW(PoseGraph{config}, std::invalid_argument);
}

TEST(PoseGraphInputTest, SolutionThatIsNotFiniteKeepsTheEstimateAndSaysSo) {
  PoseGraph graph;
  graph.addNode(step(0.0));
  graph.addNode(step(1.0));
  ASSERT_EQ(graph.optimize().failure, "");
  PoseNode absurd = step(1e200);
  absurd.sightings.push_back({1, {1e200, 0.0, 0.0}, 1e-3 * Eigen::Matrix3d::Identity()});
  graph.addNode(absurd);
  graph.addPrior(2, Pose{}, 1e-6 * PoseCov::Identity());
  const PoseGraphUpdate update = graph.optimize();
  EXPECT_NE(update.failure, "");
  EXPECT_NEAR(graph.pose(1).translation_m.x(), 1.0, 1e-9);
}

TEST(PoseGraphInputTest, EmptyGraphHasNothingToDo) {
  PoseGraph graph;
  EXPECT_EQ(graph.optimize().failure, "");
  EXPECT_EQ(graph.cost(), 0.0);
  EXPECT_FALSE(graph.landmark(3).has_value());
  EXPECT_TRUE(graph.marginals()->landmarks.empty());
  EXPECT_FALSE(graph.coarseMarginals().has_value());
}

}  // namespace
}  // namespace semantic_mht_slam
