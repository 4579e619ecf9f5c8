#include "semantic_mht_slam/common/k_best_assignment.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <set>
#include <stdexcept>
#include <utility>

#include <gtest/gtest.h>

#include "common/assignment_test_util.h"

namespace semantic_mht_slam {
namespace {

using Eigen::MatrixXd;
using testing::kForbiddenCost;

constexpr int kAll = std::numeric_limits<int>::max();
constexpr double kNoGap = std::numeric_limits<double>::infinity();

KBestOptions options(int max_assignments, double max_cost_gap = kNoGap) {
  KBestOptions result;
  result.max_assignments = max_assignments;
  result.max_cost_gap = max_cost_gap;
  return result;
}

std::vector<std::vector<int>> columnsOf(const AssignmentList& list) {
  std::vector<std::vector<int>> result;
  result.reserve(list.size());
  for (int i = 0; i < list.size(); ++i) result.push_back(list.assignment(i).column_for_row);
  return result;
}

// Murty's algorithm without any improvement: each subproblem is solved from scratch when it is made.
std::vector<double> naiveMurtyCosts(const MatrixXd& dense, int count) {
  struct Subproblem {
    double cost;
    std::vector<int> columns;
    MatrixXd dense;
    bool operator<(const Subproblem& other) const { return cost > other.cost; }
  };
  AssignmentSolver solver;
  std::priority_queue<Subproblem> queue;
  const auto push = [&](const MatrixXd& costs) {
    if (const auto found = solver.solve(SparseCostMatrix(costs)))
      queue.push({found->cost, found->column_for_row, costs});
  };
  push(dense);
  std::vector<double> result;
  while (!queue.empty() && static_cast<int>(result.size()) < count) {
    Subproblem next = queue.top();
    queue.pop();
    result.push_back(next.cost);
    for (int row = 0; row < dense.rows(); ++row) {
      const double cost = std::exchange(next.dense(row, next.columns[row]), kForbiddenCost);
      push(next.dense);
      next.dense.row(row).setConstant(kForbiddenCost);
      next.dense(row, next.columns[row]) = cost;
    }
  }
  return result;
}

// Every assignment is valid and has its true cost; they are sorted and distinct.
void expectSound(const MatrixXd& dense, const AssignmentList& found) {
  std::set<std::vector<int>> distinct;
  for (int i = 0; i < found.size(); ++i) {
    const Assignment assignment = found.assignment(i);
    ASSERT_NEAR(assignment.cost, testing::costOf(dense, assignment.column_for_row), 1e-10);
    ASSERT_TRUE(distinct.insert(assignment.column_for_row).second);
    if (i > 0) {
      ASSERT_GE(assignment.cost, found.cost(i - 1));
    }
  }
}

TEST(KBestTest, ListsAllAssignmentsThatBruteForceFinds) {
  std::mt19937 random(1);
  KBestSolver solver;
  for (int trial = 0; trial < 600; ++trial) {
    const MatrixXd dense = testing::randomCosts(testing::randomSpec(trial % 100 == 0 ? 6 : 4, random), random);
    const std::vector<Assignment> all = testing::allAssignments(dense);
    const AssignmentList& found = solver.solve(SparseCostMatrix(dense), options(kAll));
    expectSound(dense, found);
    ASSERT_EQ(found.size(), static_cast<int>(all.size())) << dense;  // with distinctness: the same set
    for (int i = 0; i < found.size(); ++i) ASSERT_NEAR(found.cost(i), all[i].cost, 1e-10) << dense;
  }
}

TEST(KBestTest, ListsTheCheapestOfBruteForceWhenKIsSmaller) {
  std::mt19937 random(2);
  KBestSolver solver;
  for (int trial = 0; trial < 600; ++trial) {
    const MatrixXd dense = testing::randomCosts(testing::randomSpec(trial % 100 == 0 ? 7 : 5, random), random);
    const std::vector<Assignment> all = testing::allAssignments(dense);
    const int k = 1 + trial % 20;
    const AssignmentList& found = solver.solve(SparseCostMatrix(dense), options(k));
    expectSound(dense, found);
    ASSERT_EQ(found.size(), std::min(k, static_cast<int>(all.size())));
    for (int i = 0; i < found.size(); ++i) ASSERT_NEAR(found.cost(i), all[i].cost, 1e-10) << dense;
  }
}

TEST(KBestTest, EqualsNaiveMurtyOnGatedMatrices) {
  std::mt19937 random(3);
  KBestSolver solver;
  for (const int landmarks : {4, 10, 20, 60}) {
    for (int trial = 0; trial < 3; ++trial) {
      const MatrixXd dense = testing::gatedCosts(15, landmarks, random);
      const std::vector<double> expected = naiveMurtyCosts(dense, 200);
      const AssignmentList& found = solver.solve(SparseCostMatrix(dense), options(200));
      expectSound(dense, found);
      ASSERT_EQ(found.size(), static_cast<int>(expected.size()));
      for (int i = 0; i < found.size(); ++i) ASSERT_NEAR(found.cost(i), expected[i], 1e-10);
    }
  }
}

TEST(KBestTest, EqualsNaiveMurtyOnDenseMatrices) {
  std::mt19937 random(4);
  KBestSolver solver;
  for (const int columns : {12, 13, 20}) {
    const MatrixXd dense = testing::randomCosts({12, columns, 0.8, false}, random);
    const std::vector<double> expected = naiveMurtyCosts(dense, 200);
    const AssignmentList& found = solver.solve(SparseCostMatrix(dense), options(200));
    expectSound(dense, found);
    ASSERT_EQ(found.size(), static_cast<int>(expected.size()));
    for (int i = 0; i < found.size(); ++i) ASSERT_NEAR(found.cost(i), expected[i], 1e-10);
  }
}

TEST(KBestTest, StopsAtTheCostGap) {
  std::mt19937 random(5);
  KBestSolver solver;
  for (int trial = 0; trial < 200; ++trial) {
    const MatrixXd dense = testing::randomCosts({4, 5, 0.8, trial % 2 == 0}, random);
    const std::vector<Assignment> all = testing::allAssignments(dense);
    if (all.empty()) continue;
    const double gap = trial % 7;
    const auto inside = std::count_if(all.begin(), all.end(), [&](const Assignment& assignment) {
      return assignment.cost <= all.front().cost + gap;
    });
    ASSERT_EQ(solver.solve(SparseCostMatrix(dense), options(kAll, gap)).size(), inside) << dense;
    ASSERT_EQ(solver.solve(SparseCostMatrix(dense), options(2, gap)).size(), std::min<long>(2, inside)) << dense;
  }
}

TEST(KBestTest, IsEmptyWithoutAnyAssignment) {
  KBestSolver solver;
  EXPECT_EQ(solver.solve(SparseCostMatrix(MatrixXd::Ones(2, 3)), options(kAll)).size(), 6);
  EXPECT_TRUE(solver.solve(SparseCostMatrix(MatrixXd::Ones(3, 2)), options(kAll)).empty());
}

TEST(KBestTest, FindsTheEmptyAssignmentOnceWithoutRows) {
  KBestSolver solver;
  const AssignmentList& found = solver.solve(SparseCostMatrix(MatrixXd(0, 3)), options(kAll));
  ASSERT_EQ(found.size(), 1);
  EXPECT_EQ(found.cost(0), 0.0);
  EXPECT_EQ(found.rows(), 0);
}

TEST(KBestTest, ASmallerKGivesThePrefixOfALargerOne) {
  std::mt19937 random(6);
  KBestSolver solver;
  for (const bool integer : {false, true}) {
    const SparseCostMatrix costs(testing::randomCosts({8, 10, 0.7, integer}, random));
    const std::vector<std::vector<int>> longer = columnsOf(solver.solve(costs, options(100)));
    std::vector<std::vector<int>> shorter = columnsOf(solver.solve(costs, options(40)));
    ASSERT_EQ(longer.size(), 100u);
    EXPECT_TRUE(std::equal(shorter.begin(), shorter.end(), longer.begin()));
  }
}

TEST(KBestTest, OrderOfRowsAndColumnsDoesNotMatter) {
  std::mt19937 random(7);
  KBestSolver solver;
  for (int trial = 0; trial < 50; ++trial) {
    const MatrixXd dense = testing::gatedCosts(15, 10, random);
    const std::vector<int> rows = testing::randomPermutation(static_cast<int>(dense.rows()), random);
    const std::vector<int> columns = testing::randomPermutation(static_cast<int>(dense.cols()), random);
    std::vector<std::vector<int>> expected = columnsOf(solver.solve(SparseCostMatrix(dense), options(50)));
    for (std::vector<int>& assignment : expected) assignment = testing::permuted(assignment, rows, columns);
    EXPECT_EQ(columnsOf(solver.solve(SparseCostMatrix(testing::permuted(dense, rows, columns)), options(50))),
              expected);
  }
}

TEST(KBestTest, ReusedSolverEqualsFreshSolver) {
  std::mt19937 random(8);
  KBestSolver reused;
  for (int trial = 0; trial < 200; ++trial) {
    const SparseCostMatrix costs(testing::randomCosts(testing::randomSpec(10, random), random));
    KBestSolver fresh;
    const AssignmentList& expected = fresh.solve(costs, options(30));
    const AssignmentList& found = reused.solve(costs, options(30));
    ASSERT_EQ(columnsOf(found), columnsOf(expected));
    for (int i = 0; i < found.size(); ++i) ASSERT_EQ(found.cost(i), expected.cost(i));
  }
}

TEST(KBestTest, CostsStayExactFarDownTheList) {
  std::mt19937 random(9);
  const MatrixXd dense = testing::gatedCosts(30, 15, random);
  KBestSolver solver;
  const AssignmentList& found = solver.solve(SparseCostMatrix(dense), options(4000));
  ASSERT_EQ(found.size(), 4000);
  expectSound(dense, found);
}

TEST(KBestTest, RejectsBadOptions) {
  KBestSolver solver;
  const SparseCostMatrix costs(MatrixXd::Ones(2, 2));
  EXPECT_THROW(solver.solve(costs, options(0)), std::invalid_argument);
  EXPECT_THROW(solver.solve(costs, options(1, -1.0)), std::invalid_argument);
  EXPECT_THROW(solver.solve(costs, options(1, std::numeric_limits<double>::quiet_NaN())), std::invalid_argument);
}

}  // namespace
}  // namespace semantic_mht_slam
