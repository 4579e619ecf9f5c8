#pragma once

#include <algorithm>
#include <limits>
#include <numeric>
#include <random>
#include <set>
#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/assignment.h"

namespace semantic_mht_slam::testing {

constexpr double kForbiddenCost = std::numeric_limits<double>::infinity();

/// What a random cost matrix looks like.
struct MatrixSpec {
  int rows = 1;
  int columns = 1;
  double density = 1.0;  ///< probability that a cell is allowed
  bool integer = false;  ///< costs -3, -2, ... 3, so that ties abound
};

/// Costs in [-10, 10], or small integers; +infinity in forbidden cells.
inline Eigen::MatrixXd randomCosts(const MatrixSpec& spec, std::mt19937& random) {
  std::uniform_real_distribution<double> real(-10.0, 10.0);
  std::uniform_int_distribution<int> integer(-3, 3);
  std::bernoulli_distribution allowed(spec.density);
  return Eigen::MatrixXd::NullaryExpr(spec.rows, spec.columns, [&] {
    const double cost = spec.integer ? integer(random) : real(random);
    return allowed(random) ? cost : kForbiddenCost;
  });
}

/// 1 to `max_rows` rows, and from one column less to three more than rows.
inline MatrixSpec randomSpec(int max_rows, std::mt19937& random) {
  MatrixSpec spec;
  spec.rows = std::uniform_int_distribution<int>(1, max_rows)(random);
  spec.columns = std::max(1, spec.rows + std::uniform_int_distribution<int>(-1, 3)(random));
  spec.density = std::uniform_int_distribution<int>(1, 4)(random) / 4.0;
  spec.integer = std::bernoulli_distribution(0.5)(random);
  return spec;
}

/// Association costs after the gate: some landmarks a row, shared between rows, and two private columns.
inline Eigen::MatrixXd gatedCosts(int rows, int landmarks, std::mt19937& random) {
  std::uniform_real_distribution<double> cost(0.0, 6.0);
  std::uniform_int_distribution<int> landmark(0, landmarks - 1);
  Eigen::MatrixXd costs = Eigen::MatrixXd::Constant(rows, landmarks + 2 * rows, kForbiddenCost);
  for (int row = 0; row < rows; ++row) {
    for (int i = 0; i < 3; ++i) costs(row, landmark(random)) = cost(random);
    costs(row, landmarks + row) = 7.0 + 0.1 * cost(random);
    costs(row, landmarks + rows + row) = 8.0 + 0.1 * cost(random);
  }
  return costs;
}

inline std::vector<int> randomPermutation(int size, std::mt19937& random) {
  std::vector<int> permutation(size);
  std::iota(permutation.begin(), permutation.end(), 0);
  std::shuffle(permutation.begin(), permutation.end(), random);
  return permutation;
}

/// Moves row i to rows[i] and column j to columns[j].
inline Eigen::MatrixXd permuted(const Eigen::MatrixXd& costs, const std::vector<int>& rows,
                                const std::vector<int>& columns) {
  Eigen::MatrixXd result(costs.rows(), costs.cols());
  for (int row = 0; row < costs.rows(); ++row) {
    for (int column = 0; column < costs.cols(); ++column) result(rows[row], columns[column]) = costs(row, column);
  }
  return result;
}

/// The same for the columns of an assignment.
inline std::vector<int> permuted(const std::vector<int>& column_for_row, const std::vector<int>& rows,
                                 const std::vector<int>& columns) {
  std::vector<int> result(column_for_row.size());
  for (int row = 0; row < static_cast<int>(result.size()); ++row) result[rows[row]] = columns[column_for_row[row]];
  return result;
}

/// Sum of the chosen cells; +infinity when a cell is forbidden or a column is taken twice.
inline double costOf(const Eigen::MatrixXd& costs, const std::vector<int>& column_for_row) {
  const std::set<int> distinct(column_for_row.begin(), column_for_row.end());
  if (static_cast<Eigen::Index>(column_for_row.size()) != costs.rows()) return kForbiddenCost;
  if (distinct.size() != column_for_row.size()) return kForbiddenCost;
  double sum = 0.0;
  for (int row = 0; row < costs.rows(); ++row) sum += costs(row, column_for_row[row]);
  return sum;
}

inline void appendCompletions(const Eigen::MatrixXd& costs, std::vector<int>& columns, std::vector<Assignment>& found) {
  const int row = static_cast<int>(columns.size());
  if (row == costs.rows()) {
    found.push_back({columns, costOf(costs, columns)});
    return;
  }
  for (int column = 0; column < costs.cols(); ++column) {
    if (costs(row, column) == kForbiddenCost) continue;
    if (std::find(columns.begin(), columns.end(), column) != columns.end()) continue;
    columns.push_back(column);
    appendCompletions(costs, columns, found);
    columns.pop_back();
  }
}

/// All assignments there are, by increasing cost.
inline std::vector<Assignment> allAssignments(const Eigen::MatrixXd& costs) {
  std::vector<Assignment> found;
  std::vector<int> columns;
  appendCompletions(costs, columns, found);
  std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  return found;
}

}  // namespace semantic_mht_slam::testing
