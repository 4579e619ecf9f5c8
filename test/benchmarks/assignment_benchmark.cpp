// Times of the assignment solvers on association problems as they leave the gate: each measurement may belong to three
// landmarks, be new, or be a false positive. Costs are negative log-likelihoods.

#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <benchmark/benchmark.h>

#include "semantic_mht_slam/common/assignment.h"
#include "semantic_mht_slam/common/k_best_assignment.h"

namespace semantic_mht_slam {
namespace {

constexpr int kMatrices = 16;  // all are solved in turn, so that no branch predictor learns one of them

enum class Neighbours { kAnywhere, kNearby };

// The two landmarks in the gate besides the true one.
std::vector<int> otherLandmarks(const std::vector<Eigen::Vector2d>& positions, int landmark, Neighbours neighbours,
                                std::mt19937& random) {
  std::vector<int> others;
  for (int i = 0; i < static_cast<int>(positions.size()); ++i) {
    if (i != landmark) others.push_back(i);
  }
  std::shuffle(others.begin(), others.end(), random);
  if (neighbours == Neighbours::kNearby) {
    std::partial_sort(others.begin(), others.begin() + 2, others.end(), [&](int a, int b) {
      return (positions[a] - positions[landmark]).norm() < (positions[b] - positions[landmark]).norm();
    });
  }
  others.resize(2);
  return others;
}

SparseCostMatrix gatedMatrix(int rows, int landmarks, Neighbours neighbours, std::mt19937& random) {
  constexpr double kGate = 11.34;  // 0.99 quantile of chi-square with 3 degrees of freedom
  constexpr double kNewCost = 7.0;
  constexpr double kFalsePositiveCost = 8.0;
  std::chi_squared_distribution<double> chi_square(3.0);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.1);

  std::vector<Eigen::Vector2d> positions(landmarks);
  for (Eigen::Vector2d& position : positions) position = {uniform(random), uniform(random)};
  std::vector<int> order(landmarks);
  for (int i = 0; i < landmarks; ++i) order[i] = i;
  std::shuffle(order.begin(), order.end(), random);

  SparseCostMatrix costs;
  costs.clear(landmarks + 2 * rows);
  for (int row = 0; row < rows; ++row) {
    costs.addRow();
    costs.add(order[row], 0.5 * std::min(chi_square(random), kGate));
    for (const int other : otherLandmarks(positions, order[row], neighbours, random)) {
      costs.add(other, 0.5 * (2.0 + (kGate - 2.0) * uniform(random)));
    }
    costs.add(landmarks + row, kNewCost + noise(random));
    costs.add(landmarks + rows + row, kFalsePositiveCost + noise(random));
  }
  return costs;
}

std::vector<SparseCostMatrix> gatedMatrices(const benchmark::State& state, Neighbours neighbours) {
  std::mt19937 random(1);
  std::vector<SparseCostMatrix> matrices;
  matrices.reserve(kMatrices);
  for (int i = 0; i < kMatrices; ++i) {
    matrices.push_back(
        gatedMatrix(static_cast<int>(state.range(0)), static_cast<int>(state.range(1)), neighbours, random));
  }
  return matrices;
}

void gatedAssignment(benchmark::State& state, Neighbours neighbours) {
  const std::vector<SparseCostMatrix> matrices = gatedMatrices(state, neighbours);
  AssignmentSolver solver;
  Assignment result;
  int next = 0;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(solver.solve(matrices[next], result));
    next = (next + 1) % kMatrices;
  }
}

void gatedKBest(benchmark::State& state, Neighbours neighbours) {
  const std::vector<SparseCostMatrix> matrices = gatedMatrices(state, neighbours);
  KBestOptions options;
  options.max_assignments = static_cast<int>(state.range(2));
  KBestSolver solver;
  int next = 0;
  while (state.KeepRunning()) {
    benchmark::DoNotOptimize(solver.solve(matrices[next], options).size());
    next = (next + 1) % kMatrices;
  }
}

void denseAssignment(benchmark::State& state) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 100.0);
  const Eigen::MatrixXd dense =
      Eigen::MatrixXd::NullaryExpr(state.range(0), state.range(1), [&] { return uniform(random); });
  const SparseCostMatrix costs(dense);
  AssignmentSolver solver;
  Assignment result;
  while (state.KeepRunning()) benchmark::DoNotOptimize(solver.solve(costs, result));
}

void gatedSizes(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"rows", "landmarks"})->Args({20, 40})->Args({50, 500})->Args({100, 1000});
  benchmark->Unit(benchmark::kMicrosecond);
}

void gatedSizesAndCounts(benchmark::internal::Benchmark* benchmark) {
  benchmark->ArgNames({"rows", "landmarks", "k"})->Unit(benchmark::kMicrosecond);
  for (const auto& [rows, landmarks] : {std::pair(20, 40), std::pair(50, 500), std::pair(100, 1000)}) {
    for (const int k : {1, 10, 100}) benchmark->Args({rows, landmarks, k});
  }
}

BENCHMARK_CAPTURE(gatedAssignment, anywhere, Neighbours::kAnywhere)->Apply(gatedSizes);
BENCHMARK_CAPTURE(gatedAssignment, nearby, Neighbours::kNearby)->Apply(gatedSizes);
BENCHMARK_CAPTURE(gatedKBest, anywhere, Neighbours::kAnywhere)->Apply(gatedSizesAndCounts);
BENCHMARK_CAPTURE(gatedKBest, nearby, Neighbours::kNearby)->Apply(gatedSizesAndCounts);
BENCHMARK(denseAssignment)->Args({100, 100})->Args({100, 300})->Args({300, 300})->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace semantic_mht_slam

BENCHMARK_MAIN();
