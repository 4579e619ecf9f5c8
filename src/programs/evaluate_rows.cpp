#include "evaluate_rows.h"

#include <algorithm>
#include <cctype>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/csv_file.h"
#include "semantic_mht_slam/io/text_file.h"

namespace semantic_mht_slam {
namespace {

bool readFlag(const CsvRow& row, std::size_t column) {
  std::string word(row.text(column));
  for (char& letter : word) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (word == "1" || word == "true") return true;
  if (word != "0" && word != "false") row.fail(column, "'" + word + "' is none of 0, 1, false, true");
  return false;
}

/// The columns of a CSV file beside those that are known.
std::vector<std::string> furtherColumns(const std::string& path, const std::vector<std::string>& known) {
  std::vector<std::string> further;
  bool is_header = true;
  forEachLine(readFile(path), [&](int, std::string_view line) {
    if (!is_header) return;
    is_header = false;
    for (const std::string_view name : split(line, ',')) {
      const bool is_new =
          std::count(known.begin(), known.end(), name) == 0 && std::count(further.begin(), further.end(), name) == 0;
      if (is_new) further.emplace_back(name);
    }
  });
  return further;
}

}  // namespace

std::vector<ClosureEstimate> readClosures(const std::string& path) {
  const std::vector<std::string> columns = {"query_frame", "match_frame", "accepted", "tx", "ty", "tz"};
  const CsvReader reader(columns, furtherColumns(path, columns));
  std::vector<ClosureEstimate> closures;
  reader.read(path, [&](const CsvRow& row) {
    ClosureEstimate closure{row.integer(0), row.integer(1), readFlag(row, 2), Eigen::Vector3d::Zero()};
    if (closure.accepted) closure.query_in_match_m = {row.number(3), row.number(4), row.number(5)};
    closures.push_back(closure);
  });
  return closures;
}

std::vector<TrueDetection> readTrueDetections(const std::string& path) {
  std::vector<TrueDetection> truth;
  CsvReader({"frame", "landmark"}).read(path, [&](const CsvRow& row) {
    truth.push_back({row.integer(0), row.integer(1)});
  });
  return truth;
}

std::vector<AssociatedDetection> readAssociations(const std::string& path) {
  std::vector<AssociatedDetection> associations;
  CsvReader({"frame", "row", "landmark"}).read(path, [&](const CsvRow& row) {
    associations.push_back({row.integer(0), row.integer(1), row.integer(2)});
  });
  return associations;
}

}  // namespace semantic_mht_slam
