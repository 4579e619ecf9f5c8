#include "semantic_mht_slam/common/assignment.h"

#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "common/assignment_test_util.h"

namespace semantic_mht_slam {
namespace {

using Eigen::MatrixXd;
using testing::kForbiddenCost;

std::string messageOf(const MatrixXd& dense) {
  try {
    SparseCostMatrix costs(dense);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

TEST(SparseCostMatrixTest, KeepsTheFiniteCellsOfADenseMatrix) {
  MatrixXd dense(2, 3);
  dense << 1.0, kForbiddenCost, -2.0, kForbiddenCost, 5.0, kForbiddenCost;
  const SparseCostMatrix costs(dense);
  EXPECT_EQ(costs.rows(), 2);
  EXPECT_EQ(costs.columns(), 3);
  ASSERT_EQ(costs.entries(), 3);
  EXPECT_EQ(costs.rowBegin(0), 0);
  EXPECT_EQ(costs.rowEnd(0), 2);
  EXPECT_EQ(costs.rowEnd(1), 3);
  EXPECT_EQ(costs.columnIndices(), (std::vector<int>{0, 2, 1}));
  EXPECT_EQ(costs.costs(), (std::vector<double>{1.0, -2.0, 5.0}));
}

TEST(SparseCostMatrixTest, NamesRowAndColumnOfANanOrMinusInfinity) {
  MatrixXd dense = MatrixXd::Zero(4, 6);
  dense(3, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(messageOf(dense), "SparseCostMatrix: row 3, column 5: cost is NaN");
  dense(2, 1) = -kForbiddenCost;
  EXPECT_EQ(messageOf(dense), "SparseCostMatrix: row 2, column 1: cost is -infinity");
}

TEST(SparseCostMatrixTest, RejectsBrokenContracts) {
  SparseCostMatrix costs;
  EXPECT_THROW(costs.clear(-1), std::invalid_argument);
  costs.clear(2);
  EXPECT_THROW(costs.add(0, 1.0), std::logic_error);
  costs.addRow();
  EXPECT_THROW(costs.add(-1, 1.0), std::invalid_argument);
  EXPECT_THROW(costs.add(2, 1.0), std::invalid_argument);
  costs.add(1, 1.0);
  EXPECT_THROW(costs.add(1, 2.0), std::invalid_argument);
  EXPECT_EQ(costs.entries(), 1);
}

TEST(SparseCostMatrixTest, ClearForgetsRowsAndEntries) {
  SparseCostMatrix costs(MatrixXd::Ones(3, 5));
  costs.clear(4);
  EXPECT_EQ(costs.rows(), 0);
  EXPECT_EQ(costs.columns(), 4);
  EXPECT_EQ(costs.entries(), 0);
  for (int row = 0; row < 3; ++row) {
    costs.addRow();
    EXPECT_NO_THROW(costs.add(row, 7.0));
  }
  EXPECT_THROW(costs.add(4, 1.0), std::invalid_argument);
  EXPECT_EQ(costs.costs(), (std::vector<double>{7.0, 7.0, 7.0}));
}

TEST(AssignmentTest, EqualsBruteForceOnRectangularMatrices) {
  std::mt19937 random(1);
  AssignmentSolver solver;
  int feasible = 0;
  for (int trial = 0; trial < 1500; ++trial) {
    const testing::MatrixSpec spec = testing::randomSpec(trial % 50 == 0 ? 7 : 5, random);
    const MatrixXd dense = testing::randomCosts(spec, random);
    const std::vector<Assignment> all = testing::allAssignments(dense);
    const std::optional<Assignment> found = solver.solve(SparseCostMatrix(dense));
    ASSERT_EQ(found.has_value(), !all.empty()) << dense;
    if (!found) continue;
    ++feasible;
    ASSERT_NEAR(found->cost, all.front().cost, 1e-12) << dense;
    ASSERT_EQ(found->cost, testing::costOf(dense, found->column_for_row)) << dense;
  }
  EXPECT_GT(feasible, 500);
  EXPECT_LT(feasible, 1400);
}

TEST(AssignmentTest, LeavesACheapColumnToTheRowThatNeedsItMost) {
  MatrixXd dense(2, 3);
  dense << 1.0, 2.0, kForbiddenCost, 0.0, kForbiddenCost, 9.0;
  EXPECT_EQ(AssignmentSolver().solve(SparseCostMatrix(dense))->column_for_row, (std::vector<int>{1, 0}));
}

TEST(AssignmentTest, HasNoSolutionWhenRowsCompeteForTooFewColumns) {
  AssignmentSolver solver;
  EXPECT_FALSE(solver.solve(SparseCostMatrix(MatrixXd::Ones(3, 2))));
  EXPECT_FALSE(solver.solve(SparseCostMatrix(MatrixXd::Ones(1, 0))));
  MatrixXd dense = MatrixXd::Ones(3, 10);
  dense.bottomRightCorner(2, 9).setConstant(kForbiddenCost);
  EXPECT_FALSE(solver.solve(SparseCostMatrix(dense)));
  dense(2, 4) = 1.0;
  EXPECT_TRUE(solver.solve(SparseCostMatrix(dense)));
}

TEST(AssignmentTest, AssignsNothingWithoutRows) {
  const std::optional<Assignment> found = AssignmentSolver().solve(SparseCostMatrix(MatrixXd(0, 4)));
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->column_for_row.empty());
  EXPECT_EQ(found->cost, 0.0);
}

// Weak duality: an assignment whose cost equals that of feasible dual variables is optimal.
void expectCertificate(const SparseCostMatrix& costs, const AssignmentSolver& solver, const Assignment& found) {
  constexpr double kTolerance = 1e-9;
  std::vector<bool> held(costs.columns(), false);
  double dual_cost = 0.0;
  for (int row = 0; row < costs.rows(); ++row) {
    held[found.column_for_row[row]] = true;
    dual_cost += solver.rowDual(row);
    for (int entry = costs.rowBegin(row); entry < costs.rowEnd(row); ++entry) {
      const double reduced = costs.cost(entry) - solver.rowDual(row) - solver.columnDual(costs.column(entry));
      ASSERT_GE(reduced, -kTolerance);
      if (costs.column(entry) == found.column_for_row[row]) {
        ASSERT_LE(reduced, kTolerance);
      }
    }
  }
  for (int column = 0; column < costs.columns(); ++column) {
    ASSERT_LE(solver.columnDual(column), 0.0);
    if (!held[column]) {
      ASSERT_EQ(solver.columnDual(column), 0.0);
    }
    dual_cost += solver.columnDual(column);
  }
  EXPECT_NEAR(dual_cost, found.cost, kTolerance * costs.rows());
}

TEST(AssignmentTest, DualVariablesCertifyOptimalityOnLargeMatrices) {
  std::mt19937 random(2);
  AssignmentSolver solver;
  const auto expect_optimal = [&](const MatrixXd& dense) {
    const SparseCostMatrix costs(dense);
    const std::optional<Assignment> found = solver.solve(costs);
    ASSERT_TRUE(found);
    EXPECT_EQ(found->cost, testing::costOf(dense, found->column_for_row));
    expectCertificate(costs, solver, *found);
  };
  for (const bool integer : {false, true}) {
    for (const double density : {0.1, 0.5, 1.0}) {
      expect_optimal(testing::randomCosts({100, 300, density, integer}, random));
      expect_optimal(testing::randomCosts({100, 102, density, integer}, random));
      expect_optimal(testing::randomCosts({60, 60, density, integer}, random));
    }
  }
  expect_optimal(testing::gatedCosts(100, 30, random));
  expect_optimal(testing::gatedCosts(100, 300, random));
}

TEST(AssignmentTest, ReusedSolverEqualsFreshSolver) {
  std::mt19937 random(3);
  AssignmentSolver reused;
  for (int trial = 0; trial < 300; ++trial) {
    const SparseCostMatrix costs(testing::randomCosts(testing::randomSpec(12, random), random));
    const std::optional<Assignment> expected = AssignmentSolver().solve(costs);
    const std::optional<Assignment> found = reused.solve(costs);
    ASSERT_EQ(found.has_value(), expected.has_value());
    if (!found) continue;
    ASSERT_EQ(found->column_for_row, expected->column_for_row);
    ASSERT_EQ(found->cost, expected->cost);
  }
}

TEST(AssignmentTest, OrderOfRowsAndColumnsDoesNotMatter) {
  std::mt19937 random(4);
  AssignmentSolver solver;
  for (int trial = 0; trial < 100; ++trial) {
    const MatrixXd dense = testing::gatedCosts(20, 12, random);
    const std::vector<int> rows = testing::randomPermutation(static_cast<int>(dense.rows()), random);
    const std::vector<int> columns = testing::randomPermutation(static_cast<int>(dense.cols()), random);
    const std::optional<Assignment> original = solver.solve(SparseCostMatrix(dense));
    const std::optional<Assignment> moved = solver.solve(SparseCostMatrix(testing::permuted(dense, rows, columns)));
    ASSERT_TRUE(original && moved);
    ASSERT_EQ(moved->column_for_row, testing::permuted(original->column_for_row, rows, columns));
    ASSERT_NEAR(moved->cost, original->cost, 1e-12);
  }
}

}  // namespace
}  // namespace semantic_mht_slam
