#include "evaluate_landmark_files.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string_view>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/csv_file.h"
#include "semantic_mht_slam/io/text_file.h"

#include "program.h"

namespace semantic_mht_slam {
namespace {

bool hasHeader(const std::string& content) {
  bool is_first = true;
  bool has_header = true;
  forEachLine(content, [&](int, std::string_view text) {
    if (is_first) has_header = !parseDouble(split(text, ',').front());
    is_first = false;
  });
  return has_header;
}

NumberedLandmarks readRows(const std::string& path, const std::string& content) {
  NumberedLandmarks result;
  forEachLine(content, [&](int line, std::string_view text) {
    const std::vector<std::string_view> cells = split(text, ',');
    if (cells.size() != 2 && cells.size() != 3) throw InputError(at(path, line) + ": a row x,y or x,y,z was expected");
    PointLandmark landmark;
    landmark.has_height = cells.size() == 3;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> value = parseDouble(cells[i]);
      if (!value || !std::isfinite(*value)) {
        throw InputError(at(path, line) + ": '" + std::string(cells[i]) + "' is not a finite number");
      }
      landmark.position_m(static_cast<Eigen::Index>(i)) = *value;
    }
    result.ids.push_back(static_cast<std::int64_t>(result.ids.size()));
    result.landmarks.push_back(landmark);
  });
  return result;
}

NumberedLandmarks readTable(const std::string& path) {
  const CsvReader reader({"x", "y"}, {"z", "class", "id", "landmark", "existence", "observations", "sxx", "sxy", "sxz",
                                      "syy", "syz", "szz"});
  NumberedLandmarks result;
  const std::string notice = reader.read(path, [&](const CsvRow& row) {
    PointLandmark landmark;
    landmark.has_height = row.has(2);
    landmark.position_m = {row.number(0), row.number(1), row.optionalNumber(2).value_or(0.0)};
    if (row.has(3)) landmark.class_name = std::string(row.text(3));
    const std::size_t id_column = row.has(4) ? 4 : 5;
    result.ids.push_back(row.has(id_column) ? row.integer(id_column) : static_cast<std::int64_t>(result.ids.size()));
    result.landmarks.push_back(landmark);
  });
  printNotice("evaluate", notice);
  return result;
}

}  // namespace

NumberedLandmarks readLandmarks(const std::string& path, const std::vector<std::string>& classes) {
  const std::string content = readFile(path);
  NumberedLandmarks all = hasHeader(content) ? readTable(path) : readRows(path, content);
  if (classes.empty()) return all;
  NumberedLandmarks result;
  for (std::size_t i = 0; i < all.ids.size(); ++i) {
    const std::string& name = all.landmarks[i].class_name;
    if (!name.empty() && std::find(classes.begin(), classes.end(), name) == classes.end()) continue;
    result.ids.push_back(all.ids[i]);
    result.landmarks.push_back(all.landmarks[i]);
  }
  return result;
}

}  // namespace semantic_mht_slam
