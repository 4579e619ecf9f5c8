#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace semantic_mht_slam {

/// Named numbers in the order of a report; NaN where one is not defined.
using Figures = std::vector<std::pair<std::string, double>>;

/// The figure of that name; NaN if there is none.
double figureOf(const Figures& figures, const std::string& name);

/// What one run of the benchmark gave.
struct BenchmarkRun {
  std::string sequence;
  std::string odometry;
  std::string objects;  ///< how the objects were chosen, as "best"
  std::string kind;     ///< what the objects are: "real", "semi-real", ...
  std::string method;
  std::uint64_t seed = 1;
  std::string failure;  ///< why there are no figures; empty: there are
  Figures figures;
};

/// One figure over the seeds.
struct FigureSummary {
  std::string name;
  double median = 0.0;
  double min = 0.0;
  double max = 0.0;
};

/// The runs that differ in their seed only.
struct BenchmarkGroup {
  BenchmarkRun first;                  ///< without its own figures
  std::vector<std::uint64_t> seeds;    ///< of the runs with figures
  int failed = 0;                      ///< runs without
  std::vector<FigureSummary> figures;  ///< over the runs where the figure is defined
};

/// Median of a figure of a group; NaN if there is none.
double medianOf(const BenchmarkGroup& group, const std::string& name);

/// The runs by everything but their seed, in the order of their first appearance.
std::vector<BenchmarkGroup> groupRuns(const std::vector<BenchmarkRun>& runs);

/// The group of `like`'s sequence, odometry and objects with another method; null if there is none with figures.
const BenchmarkGroup* groupOf(const std::vector<BenchmarkGroup>& groups, const BenchmarkGroup& like,
                              const std::string& method);

/// A method over all sequences and odometries.
struct MethodSummary {
  std::string objects;
  std::string method;
  int groups = 0;             ///< with figures
  Figures means;              ///< over the groups' medians, where defined
  double wrong_closures = 0;  ///< over all runs
};

/// The methods by objects, in the order of their first appearance.
std::vector<MethodSummary> summarizeMethods(const std::vector<BenchmarkRun>& runs);

/// Something that the benchmark is to show, and whether it does.
struct Statement {
  bool holds = false;
  std::string text;
};

/// Whether `dpmhm` is better than each other method in the mean over sequences and odometries (SE3-aligned RMSE, median
/// of the seeds), whether it is ever worse than its odometry by more than 2 %, how large its maps are,
/// whether a loop closure was wrong and whether a run failed. Statements about methods that were not run are left out.
/// Expects the figures `se3_m`, `running_mean_m`, `raw_se3_m`, `map_mb_per_km`, `closures_accepted` and
/// `closures_wrong`.
std::vector<Statement> benchmarkStatements(const std::vector<BenchmarkRun>& runs);

}  // namespace semantic_mht_slam
