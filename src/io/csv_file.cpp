#include "semantic_mht_slam/io/csv_file.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {

void CsvRow::fail(std::size_t column, const std::string& problem) const {
  throw InputError(at(path_, line_) + ": column '" + columns_[column] + "': " + problem);
}

std::string_view CsvRow::text(std::size_t column) const {
  if (!has(column)) fail(column, "empty");
  return cells_[column];
}

double CsvRow::anyNumber(std::size_t column) const {
  const std::optional<double> value = parseDouble(text(column));
  if (!value) fail(column, "'" + std::string(cells_[column]) + "' is not a number");
  return *value;
}

double CsvRow::number(std::size_t column) const {
  const double value = anyNumber(column);
  if (!std::isfinite(value)) fail(column, "'" + std::string(cells_[column]) + "' is not finite");
  return value;
}

std::int64_t CsvRow::integer(std::size_t column) const {
  const std::optional<std::int64_t> value = parseInteger(text(column));
  if (!value) fail(column, "'" + std::string(cells_[column]) + "' is not a whole number");
  return *value;
}

std::optional<double> CsvRow::optionalNumber(std::size_t column) const {
  if (!has(column)) return std::nullopt;
  return number(column);
}

std::optional<double> CsvRow::optionalAnyNumber(std::size_t column) const {
  if (!has(column)) return std::nullopt;
  return anyNumber(column);
}

CsvReader::CsvReader(std::vector<std::string> required, std::vector<std::string> optional)
    : columns_(std::move(required)), required_count_(columns_.size()) {
  columns_.insert(columns_.end(), optional.begin(), optional.end());
}

/// The column that a cell belongs to; none for those of unknown names.
struct CsvReader::Header {
  std::vector<std::optional<std::size_t>> column_of_cell;
  std::vector<std::string> unknown;
};

CsvReader::Header CsvReader::readHeader(const std::string& where, std::string_view line) const {
  Header header;
  std::vector<bool> found(columns_.size(), false);
  for (const std::string_view name : split(line, ',')) {
    const auto column = std::find(columns_.begin(), columns_.end(), name);
    if (column == columns_.end()) {
      header.column_of_cell.emplace_back();
      header.unknown.emplace_back(name);
      continue;
    }
    const auto index = static_cast<std::size_t>(column - columns_.begin());
    if (found[index]) throw InputError(where + ": column '" + std::string(name) + "' stands twice");
    found[index] = true;
    header.column_of_cell.emplace_back(index);
  }
  for (std::size_t i = 0; i < required_count_; ++i) {
    if (found[i]) continue;
    const std::string others = header.unknown.empty() ? "" : " (not known: " + joined(header.unknown) + ")";
    throw InputError(where + ": column '" + columns_[i] + "' is missing" + others);
  }
  return header;
}

std::string CsvReader::read(const std::string& path, const std::function<void(const CsvRow&)>& use) const {
  const std::string content = readFile(path);
  Header header;
  CsvRow row(path, columns_);
  forEachLine(content, [&](int line, std::string_view text) {
    if (header.column_of_cell.empty()) {
      header = readHeader(at(path, line), text);
      return;
    }
    const std::vector<std::string_view> cells = split(text, ',');
    if (cells.size() != header.column_of_cell.size()) {
      throw InputError(at(path, line) + ": " + std::to_string(cells.size()) + " columns, the header has " +
                       std::to_string(header.column_of_cell.size()));
    }
    row.line_ = line;
    row.cells_.assign(columns_.size(), {});
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (const auto column = header.column_of_cell[i]) row.cells_[*column] = cells[i];
    }
    use(row);
  });
  if (header.column_of_cell.empty()) throw InputError(path + ": empty, a header line was expected");
  if (header.unknown.empty()) return "";
  return path + ": ignored columns, known are " + joined(columns_) + ": " + joined(header.unknown);
}

}  // namespace semantic_mht_slam
