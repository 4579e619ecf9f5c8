#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/statistics.h"

#include "evaluate_benchmark_report.h"

namespace semantic_mht_slam {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kNoFigure = "-";

std::string number(double value, int decimals) {
  return std::isfinite(value) ? formatFixed(value, decimals) : kNoFigure;
}

const FigureSummary* summaryOf(const BenchmarkGroup& group, const std::string& name) {
  for (const FigureSummary& figure : group.figures) {
    if (figure.name == name) return std::isfinite(figure.median) ? &figure : nullptr;
  }
  return nullptr;
}

/// Median of the seeds, with the smallest and largest value if they differ.
std::string withRange(const BenchmarkGroup& group, const std::string& name, int decimals) {
  const FigureSummary* figure = summaryOf(group, name);
  if (figure == nullptr) return kNoFigure;
  const std::string low = number(figure->min, decimals);
  const std::string high = number(figure->max, decimals);
  const std::string middle = number(figure->median, decimals);
  return low == high ? middle : middle + " [" + low + ", " + high + "]";
}

/// What a table shows of a group.
struct Content {
  std::string title;
  std::string figure;   ///< that decides which method of a column is the best; empty: none is marked
  bool is_loss = true;  ///< smaller is better
  std::function<std::string(const BenchmarkGroup&)> text;
  std::function<std::string(const TrajectoryError&)> reference;  ///< empty: no systems to compare with
  bool has_mean = false;                                         ///< a last column with the mean of `figure`
};

std::vector<std::string> methodsOf(const std::vector<BenchmarkGroup>& part) {
  std::vector<std::string> names;
  for (const BenchmarkGroup& group : part) {
    if (std::count(names.begin(), names.end(), group.first.method) == 0) names.push_back(group.first.method);
  }
  return names;
}

const BenchmarkGroup* find(const std::vector<BenchmarkGroup>& part, const std::string& sequence,
                           const std::string& method) {
  const auto found = std::find_if(part.begin(), part.end(), [&](const BenchmarkGroup& group) {
    return group.first.sequence == sequence && group.first.method == method;
  });
  return found == part.end() ? nullptr : &*found;
}

TableCell cellOf(const BenchmarkGroup* group, const Content& content) {
  if (group == nullptr) return {kNoFigure};
  if (group->seeds.empty()) return {"failed"};
  std::string text = content.text(*group);
  if (group->failed > 0) text += " (" + std::to_string(group->failed) + " failed)";
  return {text};
}

void markBest(const std::vector<double>& losses, std::size_t column, ReportTable& table) {
  const double best = *std::min_element(losses.begin(), losses.end());
  const double worst = *std::max_element(losses.begin(), losses.end());
  if (!std::isfinite(best) || best == worst) return;
  for (std::size_t row = 0; row < losses.size(); ++row) table.rows[row][column].is_best = losses[row] == best;
}

/// The value by which methods are compared, smaller is better; infinite where there is none.
double lossOf(const BenchmarkGroup* group, const Content& content) {
  const double value = group == nullptr ? kUndefined : medianOf(*group, content.figure);
  if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
  return content.is_loss ? value : -value;
}

void addMeans(const std::vector<BenchmarkGroup>& part, const Content& content, ReportTable& table) {
  table.header.push_back("mean");
  for (std::vector<TableCell>& row : table.rows) {
    std::vector<double> values;
    for (const BenchmarkGroup& group : part) {
      const double value = medianOf(group, content.figure);
      if (group.first.method == row.front().text && std::isfinite(value)) values.push_back(value);
    }
    row.push_back({number(mean(values), 1)});
  }
}

void addReferences(const std::vector<BenchmarkReference>& references, const std::vector<std::string>& sequences,
                   const Content& content, ReportTable& table) {
  std::vector<std::string> names;
  for (const BenchmarkReference& reference : references) {
    if (std::count(names.begin(), names.end(), reference.name) == 0) names.push_back(reference.name);
  }
  for (const std::string& name : names) {
    std::vector<TableCell> row = {{name + " (to compare)"}};
    for (const std::string& sequence : sequences) {
      const auto found = std::find_if(references.begin(), references.end(), [&](const BenchmarkReference& reference) {
        return reference.name == name && reference.sequence == sequence;
      });
      row.push_back({found == references.end() ? kNoFigure : content.reference(found->error)});
    }
    table.rows.push_back(row);
  }
}

ReportTable makeTable(const std::vector<BenchmarkGroup>& part, const Content& content,
                      const std::vector<BenchmarkReference>& references = {}) {
  const BenchmarkRun& first = part.front().first;
  ReportTable table{content.title + ", objects " + first.objects + ", odometry " + first.odometry, {"method"}, {}};
  const std::vector<std::string> sequences = sequencesOf(part);
  const std::vector<std::string> methods = methodsOf(part);
  for (const std::string& method : methods) table.rows.push_back({{method}});
  for (std::size_t column = 0; column < sequences.size(); ++column) {
    std::vector<double> losses;
    std::string kind;
    for (std::size_t row = 0; row < methods.size(); ++row) {
      const BenchmarkGroup* group = find(part, sequences[column], methods[row]);
      if (group != nullptr) kind = group->first.kind;
      table.rows[row].push_back(cellOf(group, content));
      losses.push_back(lossOf(group, content));
    }
    table.header.push_back(sequences[column] + " (" + kind + ")");
    if (!content.figure.empty()) markBest(losses, column + 1, table);
  }
  if (content.has_mean) addMeans(part, content, table);
  if (content.reference) addReferences(references, sequences, content, table);
  return table;
}

Content rangeContent(const std::string& title, const std::string& figure, int decimals, bool is_loss) {
  return {title, figure, is_loss, [=](const BenchmarkGroup& group) { return withRange(group, figure, decimals); }, {}};
}

bool isDefined(const std::vector<BenchmarkGroup>& part, const std::string& figure, double above) {
  return std::any_of(part.begin(), part.end(), [&](const BenchmarkGroup& group) {
    const FigureSummary* summary = summaryOf(group, figure);
    return summary != nullptr && summary->max > above;
  });
}

std::string closureText(const BenchmarkGroup& group) {
  const FigureSummary* wrong = summaryOf(group, "closures_wrong");
  return number(medianOf(group, "closures_accepted"), 0) + " of " + number(medianOf(group, "closures_checked"), 0) +
         ", wrong " + number(wrong == nullptr ? kUndefined : wrong->max, 0) + ", recall " +
         number(medianOf(group, "closures_recall"), 2);
}

std::string mapText(const BenchmarkGroup& group) {
  return number(medianOf(group, "landmarks"), 0) + ", " + number(medianOf(group, "map_mb_per_km"), 2) + ", " +
         number(medianOf(group, "hypotheses_mean"), 1) + " / " + number(medianOf(group, "hypotheses_max"), 0);
}

}  // namespace

std::vector<ReportTable> errorTables(const std::vector<BenchmarkGroup>& part,
                                     const std::vector<BenchmarkReference>& references) {
  Content running{"Running RMSE, mean \u00b1 std, unaligned [m]", "running_mean_m", true,
                  [](const BenchmarkGroup& group) {
                    return number(medianOf(group, "running_mean_m"), 2) + " \u00b1 " +
                           number(medianOf(group, "running_std_m"), 2);
                  },
                  [](const TrajectoryError& error) {
                    return number(error.running_mean_m, 2) + " \u00b1 " + number(error.running_std_m, 2);
                  }};
  Content se3 = rangeContent("SE3-aligned RMSE [m]", "se3_m", 2, true);
  se3.reference = [](const TrajectoryError& error) { return number(error.se3_m, 2); };
  Content t_rel = rangeContent("t_rel [%]", "t_rel_percent", 2, true);
  t_rel.reference = [](const TrajectoryError& error) { return number(error.t_rel_percent, 2); };
  return {makeTable(part, running, references), makeTable(part, se3, references), makeTable(part, t_rel, references)};
}

std::vector<ReportTable> reductionTables(const std::vector<BenchmarkGroup>& part) {
  Content se3 =
      rangeContent("Reduction of the SE3-aligned RMSE against the odometry [%]", "reduction_se3_percent", 1, false);
  Content running =
      rangeContent("Reduction of the running mean against the odometry [%]", "reduction_running_percent", 1, false);
  se3.has_mean = true;
  running.has_mean = true;
  return {makeTable(part, se3), makeTable(part, running)};
}

std::vector<ReportTable> causeTables(const std::vector<BenchmarkGroup>& part) {
  std::vector<ReportTable> tables;
  if (isDefined(part, "online_se3_m", 0.0)) {
    tables.push_back(makeTable(part, rangeContent("Live estimate, SE3-aligned RMSE [m]", "online_se3_m", 2, true)));
    tables.push_back(
        makeTable(part, rangeContent("Live estimate, running mean [m]", "online_running_mean_m", 2, true)));
  }
  if (isDefined(part, "closures_checked", 0.0)) {
    tables.push_back(makeTable(
        part,
        {"Loop closures accepted of checked, wrong (worst seed), recall of revisits", "", true, closureText, {}}));
  }
  if (isDefined(part, "association_local_f1", 0.0)) {
    tables.push_back(
        makeTable(part, rangeContent("Association F1 within 300 frames", "association_local_f1", 3, false)));
    tables.push_back(makeTable(part, rangeContent("Association F1, all pairs", "association_all_f1", 3, false)));
  }
  tables.push_back(makeTable(part, {"Landmarks, map MB/km, hypotheses mean / max", "", true, mapText, {}}));
  return tables;
}

std::vector<ReportTable> methodTables(const std::vector<MethodSummary>& methods) {
  struct Column {
    const char* title;
    const char* figure;
    int decimals;
  };
  const std::vector<Column> columns = {{"SE3 RMSE [m]", "se3_m", 3},
                                       {"reduction [%]", "reduction_se3_percent", 1},
                                       {"running mean [m]", "running_mean_m", 3},
                                       {"reduction [%]", "reduction_running_percent", 1},
                                       {"t_rel [%]", "t_rel_percent", 3},
                                       {"live SE3 RMSE [m]", "online_se3_m", 3},
                                       {"association F1 (local)", "association_local_f1", 3},
                                       {"hypotheses", "hypotheses_mean", 2}};
  std::vector<ReportTable> tables;
  for (const MethodSummary& method : methods) {
    const std::string title = "Means over sequences and odometries, objects " + method.objects;
    if (tables.empty() || tables.back().title != title) {
      tables.push_back({title, {"method", "cases"}, {}});
      for (const Column& column : columns) tables.back().header.emplace_back(column.title);
      tables.back().header.emplace_back("wrong closures");
    }
    std::vector<TableCell> row = {{method.method}, {std::to_string(method.groups)}};
    for (const Column& column : columns)
      row.push_back({number(figureOf(method.means, column.figure), column.decimals)});
    row.push_back({number(method.wrong_closures, 0)});
    tables.back().rows.push_back(row);
  }
  return tables;
}

}  // namespace semantic_mht_slam
