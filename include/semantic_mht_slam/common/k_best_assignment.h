#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "semantic_mht_slam/common/assignment.h"
#include "semantic_mht_slam/common/reassignment_search.h"

namespace semantic_mht_slam {

/// Assignments of the same rows, stored without a vector for each.
class AssignmentList {
 public:
  /// Number of assignments.
  int size() const { return static_cast<int>(costs_.size()); }
  /// True without any assignment.
  bool empty() const { return costs_.empty(); }
  /// Number of rows of every assignment.
  int rows() const { return rows_; }

  /// Cost of an assignment, which must exist.
  double cost(int index) const { return costs_[index]; }
  /// Column of a row in an assignment, both of which must exist.
  int column(int index, int row) const { return columns_[static_cast<std::size_t>(index) * rows_ + row]; }
  /// Copy of an assignment. Throws std::out_of_range.
  Assignment assignment(int index) const;

  /// Removes all assignments and sets the number of rows; keeps the memory.
  void clear(int rows);
  /// Appends an assignment given by the columns of all rows.
  void append(const int* column_for_row, double cost);

 private:
  int rows_ = 0;
  std::vector<double> costs_;
  std::vector<int> columns_;
};

/// How many assignments are wanted.
struct KBestOptions {
  int max_assignments = 1;                                        ///< k, at least 1
  double max_cost_gap = std::numeric_limits<double>::infinity();  ///< to the best assignment, same unit as the costs
};

/// The k cheapest assignments of every row to a column of its own.
///
/// Murty's partition ("An algorithm for ranking all the assignments in order of increasing cost", 1968) with the
/// improvements of Miller, Stone and Cox ("Optimizing Murty's ranked assignment method", IEEE TAES 1997): a subproblem
/// inherits assignment and dual variables of its parent and is solved by one shortest path; it is not solved before its
/// lower bound becomes the least of all; and rows with large lower bounds are split off first, which leaves small
/// subproblems where the next solutions are. The partition is lazy: a subproblem does not exist until it is solved.
///
/// Up to exact ties, the assignments found do not depend on the order of rows or columns. Allocates only when a call
/// needs more memory than all calls before.
class KBestSolver {
 public:
  /// Returns distinct assignments by increasing cost (equal costs in an order fixed by the input): `max_assignments`,
  /// or all that exist when these are fewer, without those that cost more than the best one plus `max_cost_gap`. Empty
  /// when there is no assignment at all. Costs are the sums of the chosen entries up to rounding. The reference is
  /// valid until the next call. Throws std::invalid_argument when max_assignments < 1 or max_cost_gap is negative or
  /// NaN.
  const AssignmentList& solve(const SparseCostMatrix& costs, const KBestOptions& options);

 private:
  /// Cheapest assignment of one subproblem. Its free rows stand in the order of the partition: the i-th child keeps all
  /// rows after the i-th where they are, takes the i-th away from its column, and may change those before it.
  struct Node {
    double cost = 0.0;
    int parent = -1;
    int forbidden_entry = -1;  // in addition to those of its ancestors
    int next_child = 0;        // children before this one have been solved
    int free_row_count = 0;
    std::size_t first_free_row = 0;  // in free_rows_
  };

  /// A solved node, or the next child of a node under its lower bound.
  struct Candidate {
    double cost = 0.0;
    int node = -1;
    bool solved = false;
  };

  /// Orders the heap: cheaper first, at equal cost solutions before bounds, then the older node.
  struct ComesLater {
    bool operator()(const Candidate& a, const Candidate& b) const {
      if (a.cost != b.cost) return a.cost > b.cost;
      return a.solved != b.solved ? b.solved : a.node > b.node;
    }
  };

  void startTree(const SparseCostMatrix& costs);
  void openNextChild(int node_index);
  void solveNextChild(const Candidate& candidate);
  int appendChild(int parent_index);
  void removeLastNode();
  void pushCandidate(const Candidate& candidate);
  Candidate popCandidate();
  int* columnsOf(int node) { return node_columns_.data() + static_cast<std::size_t>(node) * row_count_; }

  AssignmentSolver assignment_solver_;
  Assignment best_;
  ReassignmentSearch search_;
  AssignmentList results_;
  int row_count_ = 0;
  double max_cost_ = std::numeric_limits<double>::infinity();
  std::vector<Node> nodes_;
  std::vector<int> node_columns_;   // row_count_ of each node
  std::vector<FreeRow> free_rows_;  // of all nodes
  std::vector<Candidate> queue_;    // heap, cheapest first
};

}  // namespace semantic_mht_slam
