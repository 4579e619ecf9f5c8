#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace semantic_mht_slam {

/// One row of a CSV file. Cells are addressed by their place in the `columns` list that the reader was given.
/// Every getter throws InputError naming file, line and column if the cell is missing or not of its kind.
class CsvRow {
 public:
  CsvRow(const std::string& path, const std::vector<std::string>& columns) : path_(path), columns_(columns) {}

  bool has(std::size_t column) const { return !cells_[column].empty(); }
  std::string_view text(std::size_t column) const;
  double number(std::size_t column) const;     ///< finite
  double anyNumber(std::size_t column) const;  ///< may be infinite or not a number at all
  std::int64_t integer(std::size_t column) const;
  std::optional<double> optionalNumber(std::size_t column) const;
  std::optional<double> optionalAnyNumber(std::size_t column) const;

  /// Throws InputError "file:line: column 'name': problem".
  [[noreturn]] void fail(std::size_t column, const std::string& problem) const;

 private:
  friend class CsvReader;

  const std::string& path_;
  const std::vector<std::string>& columns_;
  int line_ = 0;
  std::vector<std::string_view> cells_;
};

/// Reads CSV files whose first line names the columns, in any order. Cells hold no quotes or commas.
class CsvReader {
 public:
  /// Columns are numbered as in `required`, then as in `optional`.
  explicit CsvReader(std::vector<std::string> required, std::vector<std::string> optional = {});

  /// Calls `use` for each row. Returns which columns are not known and were ignored, as a sentence that names the file;
  /// empty if there are none. Throws InputError for a missing file, a missing or repeated column and a row with another
  /// number of cells than the header.
  [[nodiscard]] std::string read(const std::string& path, const std::function<void(const CsvRow&)>& use) const;

 private:
  struct Header;
  Header readHeader(const std::string& where, std::string_view line) const;

  std::vector<std::string> columns_;
  std::size_t required_count_;
};

}  // namespace semantic_mht_slam
