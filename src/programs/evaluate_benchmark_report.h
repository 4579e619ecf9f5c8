#pragma once

#include <string>
#include <utility>
#include <vector>

#include "semantic_mht_slam/evaluation/benchmark_table.h"
#include "semantic_mht_slam/evaluation/report_page.h"

#include "evaluate_benchmark_cells.h"
#include "evaluate_benchmark_scores.h"

namespace semantic_mht_slam {

/// A system to compare with on one sequence.
struct BenchmarkReference {
  std::string sequence;
  std::string name;
  TrajectoryError error;
  std::vector<double> running_rmse_m;  ///< over the frames
};

/// Everything that the report tells.
struct BenchmarkResult {
  BenchmarkRequest request;
  std::vector<BenchmarkCell> cells;  ///< with figures or a failure each
  std::vector<BenchmarkReference> references;
  std::string program;  ///< hash of the program that made the runs
  std::string config;   ///< effective parameters of the full system, YAML
};

/// The runs of the cells, in their order.
std::vector<BenchmarkRun> runsOf(const BenchmarkResult& result);

/// The cells of the same case in the order of the seeds, without the failed ones.
std::vector<const BenchmarkCell*> completeCells(const BenchmarkResult& result, const BenchmarkGroup& group);

/// The choice of objects and an odometry: what one set of tables and plots is about.
using BenchmarkPart = std::pair<std::string, std::string>;
std::vector<BenchmarkPart> partsOf(const std::vector<BenchmarkGroup>& groups);

/// The groups of a part.
std::vector<BenchmarkGroup> groupsOf(const std::vector<BenchmarkGroup>& groups, const BenchmarkPart& part);

/// Sequences of the groups, in their order, each once.
std::vector<std::string> sequencesOf(const std::vector<BenchmarkGroup>& groups);

/// Tables of a part: rows are methods and systems to compare with, columns sequences.
std::vector<ReportTable> errorTables(const std::vector<BenchmarkGroup>& part,
                                     const std::vector<BenchmarkReference>& references);
std::vector<ReportTable> reductionTables(const std::vector<BenchmarkGroup>& part);

/// Tables of what the errors come from: live estimate, loop closures, associations, maps. Left out where no run of the
/// part has them.
std::vector<ReportTable> causeTables(const std::vector<BenchmarkGroup>& part);

/// A row a method: means over sequences and odometries, a table a choice of objects.
std::vector<ReportTable> methodTables(const std::vector<MethodSummary>& methods);

/// Times and memory, which are measured: a row a method, a table a sequence.
std::vector<ReportTable> measuredTables(const BenchmarkResult& result);

/// Plots of a part, as SVG: error over the frames, a plot a sequence; how many hypotheses lived; what the parts that
/// can be switched off are worth; maps with loop closures.
std::vector<std::string> errorPlots(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part);
std::vector<std::string> summaryPlots(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part);
std::vector<std::string> mapPlots(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part);

/// Writes results.csv, results.json, results.md, report.html, config.yaml and times.csv to the output folder. Only
/// times.csv, and in report.html what stands between the comments "measured begin" and "measured end", differ between
/// two benchmarks of the same program with the same input.
void writeBenchmark(const BenchmarkResult& result);

}  // namespace semantic_mht_slam
