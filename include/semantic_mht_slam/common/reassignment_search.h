#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "semantic_mht_slam/common/assignment.h"

namespace semantic_mht_slam {

/// A row of a subproblem of `KBestSolver` that may still change its column.
struct FreeRow {
  int row = 0;
  int entry = 0;             ///< present entry in the cost matrix
  double column_dual = 0.0;  ///< dual variable of the present column, at most zero; free columns have zero
  double bound = 0.0;        ///< lower bound of the extra cost when this row must leave its column
};

/// Finds the cheapest change of an optimal assignment which makes one row leave its column; a part of `KBestSolver`.
///
/// The change is a shortest cycle in the residual graph. Its vertices are the free rows and one hub which stands for
/// all columns that nobody holds: row a -> row b when a takes the column of b, row -> hub when the row takes a free
/// column, hub -> row when the column of the row becomes free. The dual variables keep all reduced costs non-negative,
/// so that Dijkstra's algorithm applies, and they make the next search start where this one ended.
class ReassignmentSearch {
 public:
  /// Begins to work on a matrix, which must outlive the calls below.
  void start(const SparseCostMatrix& costs);

  /// Sets the assignment to be changed: columns of all `row_count` rows and the rows among them that are free.
  void load(const int* column_for_row, int row_count, const FreeRow* free_rows, int free_row_count);
  /// Forgets what was loaded; needs the present columns of all rows.
  void unload(const int* column_for_row, int row_count);

  /// Forbids an entry.
  void forbid(int entry) { allowed_costs_[entry] = kForbidden; }
  /// Takes back `forbid`.
  void allow(int entry) { allowed_costs_[entry] = costs_->cost(entry); }

  /// Moves the last of the loaded free rows, whose present entry must be forbidden, to another column, and other free
  /// rows where this is cheapest. Updates entries and duals of the free rows (not their bounds) and returns the extra
  /// cost; std::nullopt, and no change, when that is impossible.
  std::optional<double> moveLastRow(FreeRow* free_rows, int free_row_count);

  /// Writes the columns of the free rows into the columns of all rows.
  void storeColumns(const FreeRow* free_rows, int free_row_count, int* column_for_row) const;

  /// Computes `bound` of all loaded free rows: cheapest way out of the row plus cheapest way into its column;
  /// +infinity when there is none.
  void computeBounds(FreeRow* free_rows, int free_row_count);

 private:
  static constexpr double kForbidden = std::numeric_limits<double>::infinity();
  static constexpr int kUnheld = -1;  // column that nobody holds
  static constexpr int kFixed = -2;   // column of a row that is not free
  static constexpr int kHub = -1;     // as a predecessor
  static constexpr int kNone = -2;

  /// Shortest path to a vertex.
  struct Label {
    double distance = kForbidden;
    int previous = kNone;  // free row or hub
    int entry = kNone;     // that the previous row takes
  };

  void resetLabels(int free_row_count);
  void scan(const FreeRow* free_rows, int index, int target, double distance);
  void scanHub(const FreeRow* free_rows, int free_row_count);
  bool scanNearest(const FreeRow* free_rows, int free_row_count);
  void updateDuals(FreeRow* free_rows, int free_row_count) const;
  double applyCycle(FreeRow* free_rows, int target);

  const SparseCostMatrix* costs_ = nullptr;
  std::vector<double> allowed_costs_;  // +infinity for forbidden entries
  std::vector<int> holder_;            // of each column: index of the free row, or kUnheld or kFixed
  std::vector<Label> labels_;          // of the free rows; that of the moved row is the end of the cycle
  std::vector<int> open_;              // free rows that were reached and not yet scanned
  Label hub_;
  bool hub_open_ = false;
  std::vector<double> way_in_;  // cheapest reduced cost into the column of each free row
};

}  // namespace semantic_mht_slam
