#include "semantic_mht_slam/common/assignment.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace semantic_mht_slam {

namespace {

[[noreturn]] void throwBadEntry(int row, int column, const char* problem) {
  throw std::invalid_argument("SparseCostMatrix: row " + std::to_string(row) + ", column " + std::to_string(column) +
                              ": " + problem);
}

}  // namespace

SparseCostMatrix::SparseCostMatrix(const Eigen::Ref<const Eigen::MatrixXd>& dense) {
  clear(static_cast<int>(dense.cols()));
  for (Eigen::Index row = 0; row < dense.rows(); ++row) {
    addRow();
    for (Eigen::Index column = 0; column < dense.cols(); ++column) add(static_cast<int>(column), dense(row, column));
  }
}

void SparseCostMatrix::clear(int columns) {
  if (columns < 0) throw std::invalid_argument("SparseCostMatrix: negative number of columns");
  for (const int column : column_indices_) last_row_in_column_[column] = -1;
  if (static_cast<int>(last_row_in_column_.size()) < columns) last_row_in_column_.resize(columns, -1);
  columns_ = columns;
  row_offsets_.resize(1);
  column_indices_.clear();
  costs_.clear();
}

void SparseCostMatrix::addRow() {
  row_offsets_.push_back(row_offsets_.back());
}

void SparseCostMatrix::add(int column, double cost) {
  const int row = rows() - 1;
  if (row < 0) throw std::logic_error("SparseCostMatrix: add before addRow");
  if (column < 0 || column >= columns_) throwBadEntry(row, column, "column out of range");
  if (std::isnan(cost)) throwBadEntry(row, column, "cost is NaN");
  if (std::isinf(cost)) {
    if (cost < 0.0) throwBadEntry(row, column, "cost is -infinity");
    return;
  }
  if (last_row_in_column_[column] == row) throwBadEntry(row, column, "cell has an entry already");
  last_row_in_column_[column] = row;
  column_indices_.push_back(column);
  costs_.push_back(cost);
  ++row_offsets_.back();
}

std::optional<Assignment> AssignmentSolver::solve(const SparseCostMatrix& costs) {
  Assignment result;
  if (!solve(costs, result)) return std::nullopt;
  return result;
}

bool AssignmentSolver::solve(const SparseCostMatrix& costs, Assignment& result) {
  prepare(costs);
  for (int row = 0; row < costs.rows(); ++row) {
    if (!augment(costs, row)) return false;
  }
  result.column_for_row.resize(costs.rows());
  result.cost = 0.0;
  for (int row = 0; row < costs.rows(); ++row) {
    result.column_for_row[row] = costs.column(rows_[row].entry);
    result.cost += costs.cost(rows_[row].entry);
  }
  return true;
}

void AssignmentSolver::prepare(const SparseCostMatrix& costs) {
  for (const int column : used_columns_) columns_[column] = Column{};
  used_columns_.clear();
  if (static_cast<int>(columns_.size()) < costs.columns()) columns_.resize(costs.columns());
  rows_.assign(costs.rows(), Row{});
}

// Dijkstra's algorithm over the columns, on reduced costs, from the unassigned row `source` to the nearest free column.
bool AssignmentSolver::augment(const SparseCostMatrix& costs, int source) {
  reached_.clear();
  scanned_ = 0;
  free_distance_ = kUnreached;
  free_column_ = kNone;
  scanRow(costs, source, 0.0, 0.0);
  for (int column = takeNearestOpenColumn(); column != kNone; column = takeNearestOpenColumn()) {
    const int row = columns_[column].row;
    scanRow(costs, row, columns_[column].distance, rows_[row].dual);
  }
  const bool found = free_column_ != kNone;
  if (found) {
    updateDuals(source);
    flipPath(costs, source);
  }
  for (const int column : reached_) columns_[column].distance = kUnreached;
  return found;
}

// Relaxes all entries of a row at `distance`. Free columns need no place in the queue, the nearest one ends the search.
// For the source, whose dual is open, the "reduced" costs may be negative: all its paths share that offset.
void AssignmentSolver::scanRow(const SparseCostMatrix& costs, int row, double distance, double row_dual) {
  const bool is_source = rows_[row].entry == kNone;
  const int end = costs.rowEnd(row);
  for (int entry = costs.rowBegin(row); entry < end; ++entry) {
    const int index = costs.column(entry);
    Column& column = columns_[index];
    const double step = costs.cost(entry) - row_dual - column.dual;
    // Rounding must not lead back into columns that are final.
    const double candidate = is_source ? step : distance + std::max(0.0, step);
    if (candidate >= free_distance_ || candidate >= column.distance) continue;
    column.previous_row = row;
    column.previous_entry = entry;
    if (column.row == kNone) {
      free_distance_ = candidate;
      free_column_ = index;
    } else {
      if (column.distance == kUnreached) reached_.push_back(index);
      column.distance = candidate;
    }
  }
}

int AssignmentSolver::takeNearestOpenColumn() {
  double nearest_distance = free_distance_;
  int nearest = kNone;
  for (int i = scanned_; i < static_cast<int>(reached_.size()); ++i) {
    const double distance = columns_[reached_[i]].distance;
    if (distance >= nearest_distance) continue;
    nearest_distance = distance;
    nearest = i;
  }
  if (nearest == kNone) return kNone;
  std::swap(reached_[nearest], reached_[scanned_]);
  return reached_[scanned_++];
}

void AssignmentSolver::updateDuals(int source) {
  rows_[source].dual = free_distance_;
  for (int i = 0; i < scanned_; ++i) {
    Column& column = columns_[reached_[i]];
    const double slack = free_distance_ - column.distance;
    column.dual -= slack;
    rows_[column.row].dual += slack;
  }
}

void AssignmentSolver::flipPath(const SparseCostMatrix& costs, int source) {
  used_columns_.push_back(free_column_);
  int index = free_column_;
  for (int row = kNone; row != source;) {
    Column& column = columns_[index];
    row = column.previous_row;
    const int released_entry = std::exchange(rows_[row].entry, column.previous_entry);
    column.row = row;
    if (row != source) index = costs.column(released_entry);
  }
}

}  // namespace semantic_mht_slam
