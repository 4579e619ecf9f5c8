#include "semantic_mht_slam/graph/batch_solver.h"

#include <limits>

#include <gtest/gtest.h>

#include "semantic_mht_slam/graph/initial_guess.h"

#include "random_graph.h"

namespace semantic_mht_slam {
namespace {

template <class Graph>
class BatchSolverTest : public testing::Test {};

using Dimensions = testing::Types<BatchGraph<2>, BatchGraph<3>>;
TYPED_TEST_SUITE(BatchSolverTest, Dimensions);

template <int kDim>
constexpr int dimensionOf(const BatchGraph<kDim>*) {
  return kDim;
}

#define GRAPH_DIMENSION (dimensionOf(static_cast<const TypeParam*>(nullptr)))

template <int kDim>
double largestDifference(const BatchGraph<kDim>& a, const BatchGraph<kDim>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.poses.size(); ++i) {
    const auto difference = a.poses[i].T_world_vertex.inverse() * b.poses[i].T_world_vertex;
    largest = std::max(largest, difference.translation_m.norm());
  }
  return largest;
}

TYPED_TEST(BatchSolverTest, CostOfTheResultIsWhatChiSquareSays) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng, 0.02, 0.01, 6);
    const BatchReport report = optimizeBatch(graph);
    ASSERT_EQ(report.failure, "");
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(report.final_cost, cost(graph), 1e-9 * report.final_cost);
    const double equations = TypeParam::kDof * static_cast<double>(graph.pose_edges.size() - graph.poses.size() + 1) +
                             GRAPH_DIMENSION * static_cast<double>(graph.point_edges.size() - graph.points.size());
    EXPECT_NEAR(2.0 * report.final_cost, equations, 5.0 * std::sqrt(2.0 * equations));
  }
}

TYPED_TEST(BatchSolverTest, ExactMeasurementsAreMetExactlyFromNoEstimateAtAll) {
  Rng rng(3);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng, 1e-9, 1e-9, 4);
  for (auto& edge : graph.pose_edges) edge.information.setIdentity();
  for (auto& edge : graph.point_edges) edge.information.setIdentity();
  ASSERT_EQ(optimizeBatch(graph).failure, "");
  EXPECT_LT(cost(graph), 1e-12);
}

TYPED_TEST(BatchSolverTest, ChordalGuessOfExactMeasurementsIsExact) {
  Rng rng(4);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng, 1e-9, 1e-9);
  for (auto& edge : graph.pose_edges) edge.information.setIdentity();
  const auto poses = chordalGuess(graph);
  ASSERT_TRUE(poses.has_value());
  for (std::size_t i = 0; i < poses->size(); ++i) graph.poses[i].T_world_vertex = (*poses)[i];
  EXPECT_LT(cost(graph), 1e-12);
}

TYPED_TEST(BatchSolverTest, ResultDoesNotDependOnTheGauge) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
    fillMissingEstimates(graph);
    TypeParam moved = graph;
    const auto T_new_old = randomStep(rng, 30.0, 1.0, typename TypeParam::PoseType{});
    for (auto& pose : moved.poses) pose.T_world_vertex = T_new_old * pose.T_world_vertex;
    const double cost_here = optimizeBatch(graph).final_cost;
    const double cost_there = optimizeBatch(moved).final_cost;
    EXPECT_NEAR(cost_there, cost_here, 1e-6 * cost_here);
    for (auto& pose : graph.poses) pose.T_world_vertex = T_new_old * pose.T_world_vertex;
    EXPECT_LT(largestDifference(graph, moved), 1e-5);
  }
}

TYPED_TEST(BatchSolverTest, ResultDoesNotDependOnWhichPoseIsHeld) {
  Rng rng(8);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
  TypeParam other = graph;
  other.fixed_poses = {17};
  const double held_first = optimizeBatch(graph).final_cost;
  EXPECT_NEAR(optimizeBatch(other).final_cost, held_first, 1e-6 * held_first);
}

TYPED_TEST(BatchSolverTest, JunkEdgeOfTinyWeightChangesNothing) {
  Rng rng(5);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
  TypeParam with_junk = graph;
  const auto junk = randomStep(rng, 100.0, 1.0, typename TypeParam::PoseType{});
  with_junk.pose_edges.push_back({30, 5, junk, 1e-12 * TypeParam::PoseInformation::Identity()});
  ASSERT_EQ(optimizeBatch(graph).failure, "");
  ASSERT_EQ(optimizeBatch(with_junk).failure, "");
  EXPECT_LT(largestDifference(graph, with_junk), 1e-5);
}

TYPED_TEST(BatchSolverTest, SecondRunGivesTheSameBits) {
  Rng rng(6);
  const TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng, 0.02, 0.01, 5);
  TypeParam first = graph;
  TypeParam second = graph;
  optimizeBatch(first);
  optimizeBatch(second);
  EXPECT_EQ(largestDifference(first, second), 0.0);
  for (std::size_t i = 0; i < first.points.size(); ++i) {
    EXPECT_EQ(first.points[i].position_m, second.points[i].position_m);
  }
}

TYPED_TEST(BatchSolverTest, WrongLoopClosuresAreNamedAndDoNoHarm) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    Rng rng(seed);
    TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
    TypeParam clean = graph;
    std::vector<int> wrong;
    for (int k = 0; k < 15; ++k) {
      auto edge = graph.pose_edges.back();
      edge.from = 10 + static_cast<int>(rng.index(30));
      edge.to = static_cast<int>(rng.index(8));
      edge.T_from_to = randomStep(rng, 3.0, 0.5, typename TypeParam::PoseType{});
      wrong.push_back(static_cast<int>(graph.pose_edges.size()));
      graph.pose_edges.push_back(edge);
    }
    BatchOptions options;
    options.cauchy = true;
    options.reject_inconsistent_loops = true;
    const BatchReport report = optimizeBatch(graph, options);
    ASSERT_EQ(report.failure, "");
    std::vector<int> rejected;
    for (const RejectedLoop& loop : report.rejected_loops) rejected.push_back(loop.edge);
    EXPECT_EQ(rejected, wrong);
    optimizeBatch(clean, options);
    EXPECT_LT(largestDifference(graph, clean), 0.01);
  }
}

/// The graph is refused for a reason that contains `words`, and its estimates are untouched.
template <int kDim>
void expectRefused(BatchGraph<kDim> graph, const std::string& words) {
  const BatchGraph<kDim> before = graph;
  const BatchReport report = optimizeBatch(graph);
  EXPECT_NE(report.failure.find(words), std::string::npos) << report.failure;
  EXPECT_EQ(largestDifference(before, graph), 0.0);
}

TYPED_TEST(BatchSolverTest, DisconnectedGraphIsRefusedByTheNameOfAPose) {
  Rng rng(7);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
  fillMissingEstimates(graph);
  graph.poses.push_back({77, typename TypeParam::PoseType{}, true});
  expectRefused(graph, "pose 77 is not connected");
}

TYPED_TEST(BatchSolverTest, PointThatNobodySeesIsRefused) {
  Rng rng(7);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
  fillMissingEstimates(graph);
  graph.points.push_back({88, TypeParam::Point::Zero(), true});
  expectRefused(graph, "point 88 is never seen");
}

TYPED_TEST(BatchSolverTest, NonFiniteNumbersAreRefused) {
  Rng rng(9);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
  fillMissingEstimates(graph);
  TypeParam bad_edge = graph;
  bad_edge.pose_edges[4].T_from_to.translation_m.x() = std::numeric_limits<double>::quiet_NaN();
  const BatchReport report = optimizeBatch(bad_edge);
  EXPECT_NE(report.failure.find("not finite"), std::string::npos);
  TypeParam huge = graph;
  huge.pose_edges[4].T_from_to.translation_m.x() = 1e200;
  expectRefused(huge, "");
  EXPECT_NE(optimizeBatch(huge).failure, "");
}

TYPED_TEST(BatchSolverTest, SingularInformationIsRefused) {
  Rng rng(9);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
  fillMissingEstimates(graph);
  graph.pose_edges[4].information(0, 0) = 0.0;
  expectRefused(graph, "not positive definite");
}

TYPED_TEST(BatchSolverTest, OptionsOutOfRangeThrow) {
  Rng rng(1);
  TypeParam graph = randomGraph<GRAPH_DIMENSION>(rng);
  BatchOptions options;
  options.cauchy_scale = 0.0;
  EXPECT_THROW(optimizeBatch(graph, options), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
