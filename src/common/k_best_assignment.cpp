#include "semantic_mht_slam/common/k_best_assignment.h"

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <utility>

namespace semantic_mht_slam {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

int entryInColumn(const SparseCostMatrix& costs, int row, int column) {
  int entry = costs.rowBegin(row);
  while (costs.column(entry) != column) ++entry;
  return entry;
}

}  // namespace

Assignment AssignmentList::assignment(int index) const {
  Assignment result;
  result.cost = costs_.at(index);
  const auto first = columns_.begin() + static_cast<std::ptrdiff_t>(index) * rows_;
  result.column_for_row.assign(first, first + rows_);
  return result;
}

void AssignmentList::clear(int rows) {
  rows_ = rows;
  costs_.clear();
  columns_.clear();
}

void AssignmentList::append(const int* column_for_row, double cost) {
  costs_.push_back(cost);
  columns_.insert(columns_.end(), column_for_row, column_for_row + rows_);
}

const AssignmentList& KBestSolver::solve(const SparseCostMatrix& costs, const KBestOptions& options) {
  if (options.max_assignments < 1) throw std::invalid_argument("KBestSolver: max_assignments must be at least 1");
  if (!(options.max_cost_gap >= 0.0)) throw std::invalid_argument("KBestSolver: max_cost_gap must not be negative");
  results_.clear(costs.rows());
  if (!assignment_solver_.solve(costs, best_)) return results_;
  results_.append(best_.column_for_row.data(), best_.cost);
  if (options.max_assignments == 1) return results_;

  max_cost_ = best_.cost + options.max_cost_gap;
  startTree(costs);
  while (!queue_.empty()) {
    const Candidate candidate = popCandidate();
    if (!candidate.solved) {
      solveNextChild(candidate);
      continue;
    }
    results_.append(columnsOf(candidate.node), candidate.cost);
    if (results_.size() == options.max_assignments) break;
    openNextChild(candidate.node);
  }
  return results_;
}

void KBestSolver::startTree(const SparseCostMatrix& costs) {
  row_count_ = costs.rows();
  queue_.clear();
  nodes_.assign(1, Node{});
  nodes_[0].cost = best_.cost;
  nodes_[0].free_row_count = row_count_;
  node_columns_.assign(best_.column_for_row.begin(), best_.column_for_row.end());
  free_rows_.resize(row_count_);
  for (int row = 0; row < row_count_; ++row) {
    const int column = best_.column_for_row[row];
    free_rows_[row] = {row, entryInColumn(costs, row, column), assignment_solver_.columnDual(column), 0.0};
  }
  search_.start(costs);
  search_.load(columnsOf(0), row_count_, free_rows_.data(), row_count_);
  search_.computeBounds(free_rows_.data(), row_count_);
  search_.unload(columnsOf(0), row_count_);
  openNextChild(0);
}

// Queues the child whose bound is least among those not opened yet. It gets the next place in the partition, hence
// fewer rows to change than all children that come after it.
void KBestSolver::openNextChild(int node_index) {
  Node& node = nodes_[node_index];
  FreeRow* const first = free_rows_.data() + node.first_free_row;
  FreeRow* const begin = first + node.next_child;
  FreeRow* const end = first + node.free_row_count;
  FreeRow* const least =
      std::min_element(begin, end, [](const FreeRow& a, const FreeRow& b) { return a.bound < b.bound; });
  if (least == end || least->bound == kInfinity) return;
  std::swap(*begin, *least);
  pushCandidate({node.cost + begin->bound, node_index, false});
}

void KBestSolver::solveNextChild(const Candidate& candidate) {
  const int child = appendChild(candidate.node);
  Node& node = nodes_[child];
  FreeRow* const free_rows = free_rows_.data() + node.first_free_row;
  for (int i = child; i != 0; i = nodes_[i].parent) search_.forbid(nodes_[i].forbidden_entry);
  search_.load(columnsOf(child), row_count_, free_rows, node.free_row_count);

  const std::optional<double> extra_cost = search_.moveLastRow(free_rows, node.free_row_count);
  if (extra_cost) {
    node.cost = std::max(candidate.cost, node.cost + *extra_cost);  // below its lower bound by rounding only
    search_.storeColumns(free_rows, node.free_row_count, columnsOf(child));
    search_.computeBounds(free_rows, node.free_row_count);
    pushCandidate({node.cost, child, true});
  }
  search_.unload(columnsOf(child), row_count_);
  for (int i = child; i != 0; i = nodes_[i].parent) search_.allow(nodes_[i].forbidden_entry);
  if (!extra_cost) removeLastNode();
  openNextChild(candidate.node);
}

int KBestSolver::appendChild(int parent_index) {
  const int child_index = static_cast<int>(nodes_.size());
  Node& parent = nodes_[parent_index];
  Node child;
  child.cost = parent.cost;
  child.parent = parent_index;
  child.free_row_count = ++parent.next_child;
  child.first_free_row = free_rows_.size();
  const std::size_t source = parent.first_free_row;
  free_rows_.resize(child.first_free_row + child.free_row_count);
  std::copy_n(free_rows_.begin() + source, child.free_row_count, free_rows_.begin() + child.first_free_row);
  child.forbidden_entry = free_rows_.back().entry;
  nodes_.push_back(child);
  node_columns_.resize(nodes_.size() * row_count_);
  std::copy_n(columnsOf(parent_index), row_count_, columnsOf(child_index));
  return child_index;
}

void KBestSolver::removeLastNode() {
  free_rows_.resize(nodes_.back().first_free_row);
  nodes_.pop_back();
  node_columns_.resize(nodes_.size() * row_count_);
}

void KBestSolver::pushCandidate(const Candidate& candidate) {
  if (candidate.cost > max_cost_) return;
  queue_.push_back(candidate);
  std::push_heap(queue_.begin(), queue_.end(), ComesLater());
}

KBestSolver::Candidate KBestSolver::popCandidate() {
  std::pop_heap(queue_.begin(), queue_.end(), ComesLater());
  const Candidate candidate = queue_.back();
  queue_.pop_back();
  return candidate;
}

}  // namespace semantic_mht_slam
