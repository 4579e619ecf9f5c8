#pragma once

#include <limits>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace semantic_mht_slam {

/// Cost matrix that stores its allowed cells only (compressed rows). A cell that was never added is forbidden.
///
/// Built row by row and meant to be reused: `clear` keeps the memory, so that a loop which fills the same object for
/// every time step stops allocating once the largest matrix was seen. Entries are numbered 0, 1, ... in the order in
/// which they were added; the entries of row i are [rowBegin(i), rowEnd(i)).
class SparseCostMatrix {
 public:
  /// A matrix without rows and without columns.
  SparseCostMatrix() = default;

  /// Takes over a dense matrix in which +infinity marks forbidden cells.
  /// Throws std::invalid_argument that names row and column of a NaN or -infinity.
  explicit SparseCostMatrix(const Eigen::Ref<const Eigen::MatrixXd>& dense);

  /// Removes all rows and sets the number of columns; takes time in the number of old entries, not of columns.
  /// Throws std::invalid_argument when `columns` is negative.
  void clear(int columns);

  /// Begins the next row, without entries so far.
  void addRow();

  /// Allows `column` in the row begun last, at this cost; +infinity leaves the cell forbidden.
  /// Throws std::logic_error before the first row, std::invalid_argument (naming row and column) when the cost is NaN
  /// or -infinity, the column is out of range, or the row has an entry in this column already.
  void add(int column, double cost);

  /// Number of rows begun so far.
  int rows() const { return static_cast<int>(row_offsets_.size()) - 1; }
  /// Number of columns, with and without entries.
  int columns() const { return columns_; }
  /// Number of allowed cells.
  int entries() const { return static_cast<int>(costs_.size()); }

  /// First entry of a row; the row must exist.
  int rowBegin(int row) const { return row_offsets_[row]; }
  /// One past the last entry of a row; the row must exist.
  int rowEnd(int row) const { return row_offsets_[row + 1]; }
  /// Column of an entry; the entry must exist.
  int column(int entry) const { return column_indices_[entry]; }
  /// Cost of an entry, finite; the entry must exist.
  double cost(int entry) const { return costs_[entry]; }

  /// Costs of all entries.
  const std::vector<double>& costs() const { return costs_; }
  /// Columns of all entries.
  const std::vector<int>& columnIndices() const { return column_indices_; }

 private:
  int columns_ = 0;
  std::vector<int> row_offsets_ = {0};
  std::vector<int> column_indices_;
  std::vector<double> costs_;
  std::vector<int> last_row_in_column_;  // finds the second entry of a cell; -1 for columns without entries
};

/// A distinct column for every row, and the sum of the chosen costs.
struct Assignment {
  std::vector<int> column_for_row;  ///< one column for each row, all different
  double cost = 0.0;                ///< sum of the chosen entries, in row order
};

/// Cheapest assignment of every row to a column of its own; columns may stay free, no row may.
///
/// Shortest augmenting paths with dual variables (Jonker and Volgenant 1987; Crouse, "On implementing 2D rectangular
/// assignment algorithms", IEEE TAES 2016), rectangular and sparse without padding: O(n^3) for n x n, and on gated
/// matrices, where a path ends at the first free column, nearly linear in the number of entries.
///
/// The solver is a workspace: it remembers nothing between calls that could change a result, and allocates only when it
/// meets a larger matrix than ever before.
class AssignmentSolver {
 public:
  /// Solves one matrix; std::nullopt when the allowed cells admit no assignment of all rows.
  std::optional<Assignment> solve(const SparseCostMatrix& costs);

  /// The same into memory of the caller; without allocation once everything has grown. Returns false, and leaves an
  /// unspecified `result`, when there is no assignment.
  bool solve(const SparseCostMatrix& costs, Assignment& result);

  /// Dual variable u of a row after a successful solve: cost(i, j) >= u(i) + v(j) for all entries, with equality for
  /// the chosen ones. Throws std::out_of_range.
  double rowDual(int row) const { return rows_.at(row).dual; }

  /// Dual variable v of a column after a successful solve: at most zero, and zero for the columns that stayed free.
  /// Throws std::out_of_range.
  double columnDual(int column) const { return columns_.at(column).dual; }

 private:
  static constexpr double kUnreached = std::numeric_limits<double>::infinity();
  static constexpr int kNone = -1;

  struct Row {
    double dual = 0.0;
    int entry = kNone;  // chosen entry
  };
  struct Column {
    double dual = 0.0;
    double distance = kUnreached;  // from the row that is being added
    int row = kNone;               // that holds this column
    int previous_row = kNone;      // from which the shortest path arrives,
    int previous_entry = kNone;    // and the entry it takes
  };

  void prepare(const SparseCostMatrix& costs);
  bool augment(const SparseCostMatrix& costs, int source);
  void scanRow(const SparseCostMatrix& costs, int row, double distance, double row_dual);
  int takeNearestOpenColumn();
  void updateDuals(int source);
  void flipPath(const SparseCostMatrix& costs, int source);

  std::vector<Row> rows_;
  std::vector<Column> columns_;
  std::vector<int> used_columns_;  // all that may differ from Column{}
  std::vector<int> reached_;       // held columns on the search tree; the first `scanned_` are final
  int scanned_ = 0;
  double free_distance_ = kUnreached;  // shortest path to a free column so far
  int free_column_ = kNone;
};

}  // namespace semantic_mht_slam
