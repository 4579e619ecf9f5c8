#include <cstdlib>
#include <set>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "semantic_mht_slam/graph/batch_solver.h"
#include "semantic_mht_slam/graph/initial_guess.h"
#include "semantic_mht_slam/io/g2o_file.h"

namespace semantic_mht_slam {
namespace {

/// Folder of the benchmark graphs; empty where SEMANTIC_MHT_SLAM_DATA is not set.
std::string graphFolder() {
  const char* data = std::getenv("SEMANTIC_MHT_SLAM_DATA");
  return data == nullptr || *data == '\0' ? "" : std::string(data) + "/pose_graphs/";
}

struct KnownGraph {
  const char* name;
  double best_cost;
};

class PoseGraphFilesTest : public testing::TestWithParam<KnownGraph> {};

TEST_P(PoseGraphFilesTest, CostIsWithinATenthOfAPercentOfTheBestKnown) {
  if (graphFolder().empty()) GTEST_SKIP() << "SEMANTIC_MHT_SLAM_DATA is not set";
  G2oFile file = readG2o(graphFolder() + GetParam().name + ".g2o");
  const BatchReport report = std::visit([](auto& graph) { return optimizeBatch(graph); }, file.graph);
  EXPECT_EQ(report.failure, "");
  EXPECT_LT(report.final_cost, 1.001 * GetParam().best_cost);
  EXPECT_GT(report.final_cost, 0.999 * GetParam().best_cost);
}

INSTANTIATE_TEST_SUITE_P(Graphs, PoseGraphFilesTest,
                         testing::Values(KnownGraph{"intel", 22.502}, KnownGraph{"manhattan", 1774.52},
                                         KnownGraph{"MIT", 20.582}, KnownGraph{"CSAIL", 20.278},
                                         KnownGraph{"parking-garage", 0.63419}, KnownGraph{"sphere2500", 675.61},
                                         KnownGraph{"torus3D", 12113.5}, KnownGraph{"kitti_00", 49.161},
                                         KnownGraph{"kitti_05", 78.552}),
                         [](const auto& param_info) {
                           std::string name = param_info.param.name;
                           for (char& c : name) c = c == '-' ? '_' : c;
                           return name;
                         });

double alignedRmse(const BatchGraph<2>& estimate, const BatchGraph<2>& truth) {
  const Eigen::Index count = static_cast<Eigen::Index>(truth.poses.size());
  Eigen::Matrix3Xd a = Eigen::Matrix3Xd::Zero(3, count);
  Eigen::Matrix3Xd b = Eigen::Matrix3Xd::Zero(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    a.col(i).head<2>() = estimate.poses[static_cast<std::size_t>(i)].T_world_vertex.translation_m;
    b.col(i).head<2>() = truth.poses[static_cast<std::size_t>(i)].T_world_vertex.translation_m;
  }
  const Pose T_b_a = Pose::fromMatrix(Eigen::umeyama(a, b, false).topRows<3>());
  double sum = 0.0;
  for (Eigen::Index i = 0; i < count; ++i) sum += (T_b_a * a.col(i) - b.col(i)).squaredNorm();
  return std::sqrt(sum / static_cast<double>(count));
}

TEST(PoseGraphFilesTest, ThreeQuartersOfWrongLoopClosuresCostLessThanATenthOfTheAccuracy) {
  if (graphFolder().empty()) GTEST_SKIP() << "SEMANTIC_MHT_SLAM_DATA is not set";
  auto truth = std::get<BatchGraph<2>>(readG2o(graphFolder() + "kitti_00_dloop_ground_truth.g2o").graph);
  fillMissingEstimates(truth);
  auto graph = std::get<BatchGraph<2>>(readG2o(graphFolder() + "kitti_00_dloop_alpha0.g2o").graph);
  const auto is_right = [&truth](const auto& edge) {
    const Pose2 exact = truth.poses[edge.from].T_world_vertex.inverse() * truth.poses[edge.to].T_world_vertex;
    return (edge.T_from_to.inverse() * exact).translation_m.norm() < 5.0;
  };
  BatchGraph<2> only_right = graph;
  only_right.pose_edges.clear();
  std::set<int> wrong;
  for (int i = 0; i < static_cast<int>(graph.pose_edges.size()); ++i) {
    const auto& edge = graph.pose_edges[i];
    if (isOdometry(edge) || is_right(edge)) {
      only_right.pose_edges.push_back(edge);
    } else {
      wrong.insert(i);
    }
  }
  ASSERT_EQ(wrong.size(), 329u);
  BatchOptions options;
  options.cauchy = true;
  options.reject_inconsistent_loops = true;
  const BatchReport report = optimizeBatch(graph, options);
  ASSERT_EQ(report.failure, "");
  std::set<int> rejected;
  for (const RejectedLoop& loop : report.rejected_loops) rejected.insert(loop.edge);
  EXPECT_EQ(rejected, wrong);
  optimizeBatch(only_right);
  EXPECT_LT(alignedRmse(graph, truth), 1.1 * alignedRmse(only_right, truth));
}

}  // namespace
}  // namespace semantic_mht_slam
