// Counts heap allocations, for which it replaces the global operator new of its test program.

#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <new>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "semantic_mht_slam/common/assignment.h"
#include "semantic_mht_slam/common/k_best_assignment.h"

#include "common/assignment_test_util.h"

namespace {
std::atomic<long> allocations = 0;
}  // namespace

// Not inlined: gcc would see malloc on one side and operator delete on the other, and warn of a mismatch.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* const memory = std::malloc(size)) return memory;
  throw std::bad_alloc();
}
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  ++allocations;
  return std::malloc(size);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
  std::free(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}

namespace semantic_mht_slam {
namespace {

std::vector<Eigen::MatrixXd> denseMatrices() {
  std::mt19937 random(1);
  std::vector<Eigen::MatrixXd> matrices;
  for (const int rows : {5, 20, 10}) matrices.push_back(testing::gatedCosts(rows, 2 * rows, random));
  return matrices;
}

void fill(const Eigen::MatrixXd& dense, SparseCostMatrix& costs) {
  costs.clear(static_cast<int>(dense.cols()));
  for (int row = 0; row < dense.rows(); ++row) {
    costs.addRow();
    for (int column = 0; column < dense.cols(); ++column) costs.add(column, dense(row, column));
  }
}

TEST(AssignmentAllocationTest, FillingAndSolvingDoNotAllocateAfterTheFirstRound) {
  const std::vector<Eigen::MatrixXd> matrices = denseMatrices();
  SparseCostMatrix costs;
  AssignmentSolver solver;
  Assignment result;
  const auto run = [&] {
    const long before = allocations.load();
    for (const Eigen::MatrixXd& dense : matrices) {
      fill(dense, costs);
      solver.solve(costs, result);
    }
    return allocations.load() - before;
  };
  EXPECT_GT(run(), 0);
  EXPECT_EQ(run(), 0);
}

TEST(AssignmentAllocationTest, KBestDoesNotAllocateAfterTheFirstRound) {
  const std::vector<Eigen::MatrixXd> matrices = denseMatrices();
  SparseCostMatrix costs;
  KBestSolver solver;
  KBestOptions options;
  options.max_assignments = 50;
  const auto run = [&] {
    const long before = allocations.load();
    for (const Eigen::MatrixXd& dense : matrices) {
      fill(dense, costs);
      solver.solve(costs, options);
    }
    return allocations.load() - before;
  };
  EXPECT_GT(run(), 0);
  EXPECT_EQ(run(), 0);
}

}  // namespace
}  // namespace semantic_mht_slam
