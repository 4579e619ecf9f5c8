#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "../../src/graph/block_cholesky.h"
#include "drive_through.h"

namespace semantic_mht_slam {
namespace {

/// A chain of blocks with a few ties across.
const std::vector<std::vector<int>> kCliques = {{0, 1}, {1, 2}, {2, 3},  {3, 4},   {4, 5},    {5, 6},  {6, 7},
                                                {7, 8}, {8, 9}, {9, 10}, {10, 11}, {0, 7, 4}, {2, 11}, {5, 9}};
constexpr int kBlocks = 12;

class BlockCholeskyTest : public testing::Test {
 protected:
  BlockCholeskyTest() : dense_(10.0 * Eigen::MatrixXd::Identity(6 * kBlocks, 6 * kBlocks)) {
    for (int i = 0; i < kBlocks; ++i) sparse_.add(i, i, 10.0 * Matrix6d::Identity());
    Rng rng(3);
    for (const std::vector<int>& clique : kCliques) {
      Eigen::MatrixXd rows(4, 6 * static_cast<Eigen::Index>(clique.size()));
      for (Eigen::Index i = 0; i < rows.size(); ++i) rows(i) = rng.normal();
      for (std::size_t a = 0; a < clique.size(); ++a) {
        for (std::size_t b = 0; b <= a; ++b) {
          const Matrix6d block = rows.middleCols<6>(6 * static_cast<Eigen::Index>(a)).transpose() *
                                 rows.middleCols<6>(6 * static_cast<Eigen::Index>(b));
          sparse_.add(clique[a], clique[b], block);
          dense_.block<6, 6>(6 * clique[a], 6 * clique[b]) += block;
          if (a != b) dense_.block<6, 6>(6 * clique[b], 6 * clique[a]) += block.transpose();
        }
      }
    }
  }

  BlockCholesky sparse_{kBlocks, kCliques};
  Eigen::MatrixXd dense_;
};

TEST_F(BlockCholeskyTest, TheSolutionIsThatOfTheDenseMatrix) {
  ASSERT_TRUE(sparse_.factorize());
  const Eigen::MatrixXd right = Eigen::MatrixXd::Random(6 * kBlocks, 3);
  EXPECT_LT((dense_ * sparse_.solve(right) - right).norm(), 1e-10);
}

TEST_F(BlockCholeskyTest, TheInverseOfEveryCliqueIsThatOfTheDenseMatrix) {
  ASSERT_TRUE(sparse_.factorize());
  sparse_.invert();
  const Eigen::MatrixXd inverse = dense_.inverse();
  for (const std::vector<int>& clique : kCliques) {
    for (const int a : clique) {
      for (const int b : clique) {
        EXPECT_LT((sparse_.inverse(a, b) - inverse.block<6, 6>(6 * a, 6 * b)).norm(), 1e-12) << a << " " << b;
      }
    }
  }
}

TEST_F(BlockCholeskyTest, AMatrixThatIsNotPositiveDefiniteHasNoFactor) {
  sparse_.add(3, 3, -1e3 * Matrix6d::Identity());
  EXPECT_FALSE(sparse_.factorize());
}

/// A straight drive of steps of 1 m.
class StraightDrive {
 public:
  explicit StraightDrive(int nodes, double shared_m = 0.0) {
    for (int i = 0; i < nodes; ++i) {
      PoseNode node;
      if (i > 0) node.T_previous_node.translation_m.x() = 1.0;
      node.odometry_cov.diagonal() << 1e-2, 1e-2, 1e-2, 1e-6, 1e-6, 1e-6;
      node.shared_errors(0, 0) = shared_m;
      graph.addNode(node);
      EXPECT_EQ(graph.optimize().failure, "");
    }
  }

  double variance_m2(int node) const { return graph.marginals()->poses[static_cast<std::size_t>(node)](0, 0); }
  double coarseVariance_m2() const { return graph.coarseMarginals()->back().total()(0, 0); }

  PoseGraph graph;
};

TEST(GraphMarginalsTest, NoiseGrowsWithTheWayAndWhatStepsShareWithItsSquare) {
  EXPECT_NEAR(StraightDrive(36).variance_m2(35), 35 * 1e-2, 1e-9);
  const StraightDrive drive(36, 0.02);
  EXPECT_NEAR(drive.variance_m2(35), 35 * 1e-2 + 0.7 * 0.7, 1e-9);
  EXPECT_NEAR(drive.coarseVariance_m2(), drive.variance_m2(35), 1e-9) << "the skeleton loses nothing of a chain";
}

TEST(GraphMarginalsTest, AClosureShrinksThem) {
  StraightDrive drive(36, 0.02);
  const double before_m2 = drive.variance_m2(35);
  LoopConstraint loop{0, 35, {}, 1e-3 * PoseCov::Identity()};
  loop.T_from_to.translation_m.x() = 35.5;
  drive.graph.addLoopClosure(loop);
  ASSERT_EQ(drive.graph.optimizeFully().failure, "");
  ASSERT_EQ(drive.graph.loopDecisions().front().state, LoopState::kAccepted);
  EXPECT_LT(drive.variance_m2(35), 0.05 * before_m2);
  EXPECT_LT(drive.variance_m2(20), 0.5 * before_m2);
  EXPECT_LT(drive.coarseVariance_m2(), 0.3 * before_m2) << "between hub and ends odometry counts twice";
}

TEST(GraphMarginalsTest, TheSkeletonSaysNearlyTheSameOfADriveThroughATown) {
  Rng rng(5);
  const SimulatedDrive simulated = simulateDrive(smallTown(150), rng);
  Driven driven = driveThrough(simulated);
  ASSERT_EQ(driven.graph.optimizeFully().failure, "");
  const auto exact = driven.graph.marginals();
  const auto coarse = driven.graph.coarseMarginals();
  ASSERT_TRUE(exact && coarse);
  EXPECT_EQ(coarse->back().node, 149);
  double mean_ratio = 0.0;
  for (const NodeMarginal& marginal : *coarse) {
    if (marginal.node == 0) continue;
    const PoseCov& full = exact->poses[static_cast<std::size_t>(marginal.node)];
    const double ratio = std::sqrt(marginal.total().topLeftCorner<3, 3>().trace() / full.topLeftCorner<3, 3>().trace());
    EXPECT_GT(ratio, 0.7) << marginal.node;
    mean_ratio += ratio / static_cast<double>(coarse->size() - 1);
  }
  EXPECT_LT(mean_ratio, 3.5) << "hubs are 300 m apart here";
}

}  // namespace
}  // namespace semantic_mht_slam
