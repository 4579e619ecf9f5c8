#include <stdexcept>

#include <gtest/gtest.h>

#include "semantic_mht_slam/graph/pose_graph.h"

namespace semantic_mht_slam {
namespace {

PoseCov diagonal(double stddev) {
  return stddev * stddev * PoseCov::Identity();
}

/// Straight on, a metre a node, and exact.
PoseGraph straight(int nodes) {
  PoseGraph graph;
  for (int i = 0; i < nodes; ++i) {
    PoseNode node;
    node.T_previous_node.translation_m.x() = i == 0 ? 0.0 : 1.0;
    node.odometry_cov = diagonal(0.01);
    graph.addNode(node);
    EXPECT_EQ(graph.optimize().failure, "");
  }
  return graph;
}

/// Says that the last node is where the first is.
LoopConstraint backToTheStart(const PoseGraph& graph, bool is_certain) {
  return {0, graph.nodes() - 1, Pose::identity(), diagonal(0.01), is_certain};
}

class RequestedLoopsTest : public testing::TestWithParam<int> {};

TEST_P(RequestedLoopsTest, AClosureAgainstAllOdometryHoldsOnlyIfItIsCertain) {
  PoseGraph graph = straight(GetParam());
  const int loop = graph.addLoopClosure(backToTheStart(graph, false));
  EXPECT_EQ(graph.optimizeFully().failure, "");
  EXPECT_EQ(graph.loopDecisions()[loop].state, LoopState::kContradictsOdometry);
  const int certain = graph.addLoopClosure(backToTheStart(graph, true));
  EXPECT_EQ(graph.optimizeFully().failure, "");
  EXPECT_EQ(graph.loopDecisions()[certain].state, LoopState::kAccepted);
  EXPECT_LT(graph.pose(GetParam() - 1).translation_m.norm(), 0.2 * GetParam());
}

TEST_P(RequestedLoopsTest, ARemovedClosureLeavesTheGraphAsItWas) {
  PoseGraph graph = straight(GetParam());
  const std::vector<Pose> before = graph.poses();
  const int loop = graph.addLoopClosure(backToTheStart(graph, true));
  EXPECT_EQ(graph.optimizeFully().failure, "");
  graph.removeLoopClosure(loop);
  ASSERT_EQ(graph.decide().size(), 1U);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(graph.optimizeFully().failure, "");
  EXPECT_EQ(graph.loopDecisions()[loop].state, LoopState::kRemoved);
  for (int i = 0; i < graph.nodes(); ++i) {
    EXPECT_LT((graph.pose(i).translation_m - before[i].translation_m).norm(), 0.01) << i;
  }
  EXPECT_THROW(graph.removeLoopClosure(loop + 1), std::invalid_argument);
}

INSTANTIATE_TEST_SUITE_P(Nodes, RequestedLoopsTest, testing::Values(6, 60, 200));

}  // namespace
}  // namespace semantic_mht_slam
