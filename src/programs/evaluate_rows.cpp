#include "evaluate_rows.h"

#include <cctype>
#include <string>

#include "semantic_mht_slam/io/csv_file.h"

#include "program.h"

namespace semantic_mht_slam {
namespace {

bool readFlag(const CsvRow& row, std::size_t column) {
  std::string word(row.text(column));
  for (char& letter : word) letter = static_cast<char>(std::tolower(static_cast<unsigned char>(letter)));
  if (word == "1" || word == "true") return true;
  if (word != "0" && word != "false") row.fail(column, "'" + word + "' is none of 0, 1, false, true");
  return false;
}

}  // namespace

std::vector<ClosureEstimate> readClosures(const std::string& path) {
  const CsvReader reader({"query_frame", "match_frame", "accepted", "tx", "ty", "tz"});
  std::vector<ClosureEstimate> closures;
  const std::string other_columns = reader.read(path, [&](const CsvRow& row) {
    ClosureEstimate closure{row.integer(0), row.integer(1), readFlag(row, 2), Eigen::Vector3d::Zero()};
    if (closure.accepted) closure.query_in_match_m = {row.number(3), row.number(4), row.number(5)};
    closures.push_back(closure);
  });
  return closures;
}

std::vector<TrueDetection> readTrueDetections(const std::string& path) {
  std::vector<TrueDetection> truth;
  const auto add = [&](const CsvRow& row) { truth.push_back({row.integer(0), row.integer(1)}); };
  printNotice("evaluate", CsvReader({"frame", "landmark"}).read(path, add));
  return truth;
}

std::vector<AssociatedDetection> readAssociations(const std::string& path) {
  std::vector<AssociatedDetection> associations;
  const auto add = [&](const CsvRow& row) { associations.push_back({row.integer(0), row.integer(1), row.integer(2)}); };
  printNotice("evaluate", CsvReader({"frame", "row", "landmark"}).read(path, add));
  return associations;
}

}  // namespace semantic_mht_slam
