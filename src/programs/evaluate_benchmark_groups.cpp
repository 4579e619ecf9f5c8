#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/text.h"

#include "evaluate_benchmark_report.h"

namespace semantic_mht_slam {
namespace {

/// Median over some runs of a measured figure, and its largest value.
struct Measured {
  std::vector<double> values;

  std::string text(int decimals) const {
    if (values.empty()) return "-";
    std::vector<double> sorted(values);
    std::sort(sorted.begin(), sorted.end());
    return formatFixed(sorted[sorted.size() / 2], decimals) + " / " + formatFixed(sorted.back(), decimals);
  }
};

ReportTable measuredTable(const BenchmarkResult& result, const std::string& sequence) {
  struct Column {
    const char* title;
    const char* figure;
    int decimals;
  };
  const std::vector<Column> columns = {{"seconds", "seconds", 2},
                                       {"ms a frame", "ms_mean", 3},
                                       {"99 % of the frames, ms", "ms_p99", 2},
                                       {"slowest frame, ms", "ms_max", 1},
                                       {"mapping, ms a frame", "mapping_ms_mean", 3},
                                       {"99 % of the frames, ms", "mapping_ms_p99", 2},
                                       {"peak memory, MB", "peak_rss_mb", 0}};
  ReportTable table{
      "Sequence " + sequence + ", all odometries and objects: median / largest of the runs", {"method"}, {}};
  for (const Column& column : columns) table.header.emplace_back(column.title);
  for (const BenchmarkMethod& method : benchmarkMethods()) {
    std::vector<Measured> measured(columns.size());
    for (const BenchmarkCell& cell : result.cells) {
      if (cell.run.sequence != sequence || cell.method != &method || !cell.run.failure.empty()) continue;
      const Figures figures = measuredOf(cell);
      for (std::size_t i = 0; i < columns.size(); ++i) {
        const double value = figureOf(figures, columns[i].figure);
        if (std::isfinite(value)) measured[i].values.push_back(value);
      }
    }
    if (measured.front().values.empty()) continue;
    std::vector<TableCell> row = {{method.name}};
    for (std::size_t i = 0; i < columns.size(); ++i) row.push_back({measured[i].text(columns[i].decimals)});
    table.rows.push_back(row);
  }
  return table;
}

template <class Item>
void addOnce(const Item& item, std::vector<Item>& items) {
  if (std::find(items.begin(), items.end(), item) == items.end()) items.push_back(item);
}

}  // namespace

std::vector<BenchmarkRun> runsOf(const BenchmarkResult& result) {
  std::vector<BenchmarkRun> runs;
  for (const BenchmarkCell& cell : result.cells) runs.push_back(cell.run);
  return runs;
}

std::vector<const BenchmarkCell*> completeCells(const BenchmarkResult& result, const BenchmarkGroup& group) {
  std::vector<const BenchmarkCell*> cells;
  for (const BenchmarkCell& cell : result.cells) {
    const BenchmarkRun& run = cell.run;
    const bool is_member = run.sequence == group.first.sequence && run.odometry == group.first.odometry &&
                           run.objects == group.first.objects && run.method == group.first.method;
    if (is_member && run.failure.empty()) cells.push_back(&cell);
  }
  return cells;
}

std::vector<BenchmarkPart> partsOf(const std::vector<BenchmarkGroup>& groups) {
  std::vector<BenchmarkPart> parts;
  for (const BenchmarkGroup& group : groups) addOnce({group.first.objects, group.first.odometry}, parts);
  std::stable_sort(parts.begin(), parts.end(), [&](const BenchmarkPart& a, const BenchmarkPart& b) {
    const auto rank = [&](const BenchmarkPart& part) {
      return std::find_if(groups.begin(), groups.end(),
                          [&](const BenchmarkGroup& group) { return group.first.objects == part.first; });
    };
    return rank(a) < rank(b);
  });
  return parts;
}

std::vector<BenchmarkGroup> groupsOf(const std::vector<BenchmarkGroup>& groups, const BenchmarkPart& part) {
  std::vector<BenchmarkGroup> result;
  for (const BenchmarkGroup& group : groups) {
    if (BenchmarkPart(group.first.objects, group.first.odometry) == part) result.push_back(group);
  }
  return result;
}

std::vector<std::string> sequencesOf(const std::vector<BenchmarkGroup>& groups) {
  std::vector<std::string> sequences;
  for (const BenchmarkGroup& group : groups) addOnce(group.first.sequence, sequences);
  return sequences;
}

std::vector<ReportTable> measuredTables(const BenchmarkResult& result) {
  std::vector<std::string> sequences;
  for (const BenchmarkCell& cell : result.cells) addOnce(cell.run.sequence, sequences);
  std::vector<ReportTable> tables;
  for (const std::string& sequence : sequences) tables.push_back(measuredTable(result, sequence));
  return tables;
}

}  // namespace semantic_mht_slam
