#include <algorithm>
#include <cmath>
#include <cstddef>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/benchmark_table.h"
#include "semantic_mht_slam/evaluation/statistics.h"

namespace semantic_mht_slam {
namespace {

constexpr const char* kFullSystem = "dpmhm";
constexpr double kAllowedLoss = 0.02;
constexpr double kMapMbPerKm = 1.0;
constexpr std::size_t kNamedCases = 12;

std::string nameOf(const BenchmarkRun& run) {
  return run.sequence + " " + run.odometry;
}

/// "a, b, c and 4 more".
std::string firstOf(const std::vector<std::string>& names) {
  if (names.size() <= kNamedCases) return joined(names);
  const std::vector<std::string> head(names.begin(), names.begin() + kNamedCases);
  return joined(head) + " and " + std::to_string(names.size() - kNamedCases) + " more";
}

std::string metres(double value) {
  return formatFixed(value, 3) + " m";
}

/// One figure of the full system and of another method, over the cases where both have it.
struct PairedFigure {
  std::vector<double> own;
  std::vector<double> other;

  void add(const BenchmarkGroup& own_group, const BenchmarkGroup& other_group, const char* name) {
    const double a = medianOf(own_group, name);
    const double b = medianOf(other_group, name);
    if (!std::isfinite(a) || !std::isfinite(b)) return;
    own.push_back(a);
    other.push_back(b);
  }

  double difference() const { return own.empty() ? 0.0 : mean(own) - mean(other); }
  std::string text(int digits) const {
    return formatFixed(mean(own), digits) + " against " + formatFixed(mean(other), digits);
  }
};

/// The full system against another method, over the cases where both have figures.
struct Comparison {
  PairedFigure association;  ///< local F1
  PairedFigure recall;       ///< of revisits, by loop closures
  std::vector<double> own_m;
  std::vector<double> other_m;
  std::vector<double> own_running_m;
  std::vector<double> other_running_m;
  std::vector<std::string> not_better;  ///< cases where the other one is as good or better
};

Comparison compare(const std::vector<BenchmarkGroup>& groups, const std::string& objects, const std::string& method) {
  Comparison result;
  for (const BenchmarkGroup& group : groups) {
    if (group.first.objects != objects || group.first.method != kFullSystem || group.seeds.empty()) continue;
    const BenchmarkGroup* other = groupOf(groups, group, method);
    if (other == nullptr) continue;
    result.own_m.push_back(medianOf(group, "se3_m"));
    result.other_m.push_back(medianOf(*other, "se3_m"));
    result.own_running_m.push_back(medianOf(group, "running_mean_m"));
    result.other_running_m.push_back(medianOf(*other, "running_mean_m"));
    result.association.add(group, *other, "association_local_f1");
    result.recall.add(group, *other, "closures_recall");
    if (!(result.own_m.back() < result.other_m.back())) result.not_better.push_back(nameOf(group.first));
  }
  return result;
}

/// Where a better trajectory was lost: in the association, in the closures, or behind both.
std::string reasonOf(const Comparison& comparison) {
  constexpr double kSame = 0.005;
  const PairedFigure& association = comparison.association;
  const PairedFigure& recall = comparison.recall;
  if (association.own.empty() && recall.own.empty()) return "";
  std::string reason = "; why:";
  if (!association.own.empty()) reason += " association F1 " + association.text(3) + ",";
  if (!recall.own.empty()) reason += " revisits closed " + recall.text(3) + ",";
  reason.pop_back();
  if (association.difference() < 0.0) return reason + ": its association is worse";
  if (recall.difference() < -kSame) return reason + ": it closes fewer revisits";
  if (recall.difference() > kSame) return reason + ": the revisits that it closes more do not lower the error";
  return reason + ": both close the same revisits by the same back end, whose robust loss and merged landmarks " +
         "make up for what the other associates wrong";
}

Statement compared(const Comparison& comparison, const std::string& objects, const std::string& method) {
  const double own_m = mean(comparison.own_m);
  const double other_m = mean(comparison.other_m);
  Statement statement{own_m < other_m, ""};
  statement.text = std::string("objects ") + objects + ": " + kFullSystem + " is " +
                   (statement.holds ? "better than " : "NOT better than ") + method + " in the mean of " +
                   std::to_string(comparison.own_m.size()) + " sequences and odometries: SE3-aligned RMSE " +
                   metres(own_m) + " against " + metres(other_m) + " (running mean " +
                   metres(mean(comparison.own_running_m)) + " against " + metres(mean(comparison.other_running_m)) +
                   ")";
  const std::size_t better = comparison.own_m.size() - comparison.not_better.size();
  statement.text += "; better in " + std::to_string(better) + " of them";
  if (!comparison.not_better.empty()) statement.text += ", not in " + firstOf(comparison.not_better);
  if (!statement.holds) statement.text += reasonOf(comparison);
  return statement;
}

Statement neverWorseThanOdometry(const std::vector<BenchmarkRun>& runs) {
  std::vector<std::string> worse;
  double worst = -1.0;
  int count = 0;
  for (const BenchmarkRun& run : runs) {
    const double loss = figureOf(run.figures, "se3_m") / figureOf(run.figures, "raw_se3_m") - 1.0;
    if (run.method != kFullSystem || !std::isfinite(loss)) continue;
    ++count;
    worst = std::max(worst, loss);
    if (loss > kAllowedLoss) {
      worse.push_back(nameOf(run) + " " + run.objects + " seed " + std::to_string(run.seed) + " (" +
                      formatFixed(100.0 * loss, 1) + " %)");
    }
  }
  const std::string of_all = std::to_string(count) + " runs of " + kFullSystem;
  if (worse.empty()) {
    return {true, "none of " + of_all +
                      " is worse than its odometry by more than 2 % (SE3-aligned RMSE; worst change " +
                      formatFixed(100.0 * worst, 1) + " %)"};
  }
  return {false, std::to_string(worse.size()) + " of " + of_all +
                     " are WORSE than their odometry by more than 2 % (SE3-aligned RMSE): " + firstOf(worse)};
}

Statement noWrongClosure(const std::vector<BenchmarkRun>& runs) {
  double accepted = 0.0;
  double wrong = 0.0;
  std::vector<std::string> with_wrong;
  for (const BenchmarkRun& run : runs) {
    if (const double value = figureOf(run.figures, "closures_accepted"); std::isfinite(value)) accepted += value;
    const double value = figureOf(run.figures, "closures_wrong");
    if (!(value > 0.0)) continue;
    wrong += value;
    with_wrong.push_back(nameOf(run) + " " + run.objects + " " + run.method + " seed " + std::to_string(run.seed));
  }
  const std::string all = formatFixed(accepted, 0) + " loop closures accepted in all runs";
  if (accepted == 0.0) return {true, "no loop closure was accepted in any run"};
  if (with_wrong.empty()) return {true, all + ", none of them wrong"};
  return {false, all + ", " + formatFixed(wrong, 0) + " of them WRONG: " + firstOf(with_wrong)};
}

Statement smallMaps(const std::vector<BenchmarkRun>& runs) {
  double largest = 0.0;
  std::string where;
  for (const BenchmarkRun& run : runs) {
    const double size = figureOf(run.figures, "map_mb_per_km");
    if (run.method != kFullSystem || !(size > largest)) continue;
    largest = size;
    where = nameOf(run) + " " + run.objects;
  }
  const bool holds = largest < kMapMbPerKm;
  return {holds, std::string("the largest map of ") + kFullSystem + " takes " + formatFixed(largest, 2) +
                     " MB per km of driving (" + where + ")" + (holds ? ", less than 1" : ", MORE than 1")};
}

bool anyRun(const std::vector<BenchmarkRun>& runs, const std::string& method) {
  return std::any_of(runs.begin(), runs.end(), [&](const BenchmarkRun& run) { return run.method == method; });
}

}  // namespace

std::vector<Statement> benchmarkStatements(const std::vector<BenchmarkRun>& runs) {
  const std::vector<BenchmarkGroup> groups = groupRuns(runs);
  std::vector<Statement> result;
  for (const MethodSummary& other : summarizeMethods(runs)) {
    if (other.method == kFullSystem) continue;
    const Comparison comparison = compare(groups, other.objects, other.method);
    if (!comparison.own_m.empty()) result.push_back(compared(comparison, other.objects, other.method));
  }
  if (anyRun(runs, kFullSystem)) {
    result.push_back(neverWorseThanOdometry(runs));
    result.push_back(smallMaps(runs));
  }
  result.push_back(noWrongClosure(runs));
  const auto failed =
      std::count_if(runs.begin(), runs.end(), [](const BenchmarkRun& run) { return !run.failure.empty(); });
  if (failed > 0)
    result.push_back({false, std::to_string(failed) + " of " + std::to_string(runs.size()) + " runs FAILED"});
  return result;
}

}  // namespace semantic_mht_slam
