#include "semantic_mht_slam/evaluation/benchmark_table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "semantic_mht_slam/evaluation/statistics.h"

namespace semantic_mht_slam {
namespace {

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();

bool isSameCase(const BenchmarkRun& a, const BenchmarkRun& b) {
  return a.sequence == b.sequence && a.odometry == b.odometry && a.objects == b.objects;
}

/// Adds the names of `figures` that `names` lacks.
void addNames(const Figures& figures, std::vector<std::string>& names) {
  for (const auto& [name, value] : figures) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
}

std::vector<FigureSummary> summarize(const std::vector<const BenchmarkRun*>& runs) {
  std::vector<std::string> names;
  for (const BenchmarkRun* run : runs) addNames(run->figures, names);
  std::vector<FigureSummary> result;
  for (const std::string& name : names) {
    std::vector<double> values;
    for (const BenchmarkRun* run : runs) {
      const double value = figureOf(run->figures, name);
      if (std::isfinite(value)) values.push_back(value);
    }
    if (values.empty()) {
      result.push_back({name, kUndefined, kUndefined, kUndefined});
    } else {
      const auto [low, high] = std::minmax_element(values.begin(), values.end());
      result.push_back({name, median(values), *low, *high});
    }
  }
  return result;
}

BenchmarkGroup makeGroup(const std::vector<const BenchmarkRun*>& runs) {
  BenchmarkGroup group;
  group.first = *runs.front();
  group.first.figures.clear();
  std::vector<const BenchmarkRun*> complete;
  for (const BenchmarkRun* run : runs) {
    if (run->failure.empty()) {
      complete.push_back(run);
      group.seeds.push_back(run->seed);
    } else {
      ++group.failed;
    }
  }
  group.figures = summarize(complete);
  return group;
}

MethodSummary summarizeMethod(const std::vector<BenchmarkGroup>& groups, const std::string& objects,
                              const std::string& method) {
  MethodSummary summary{objects, method, 0, {}, 0.0};
  std::vector<std::string> names;
  std::vector<const BenchmarkGroup*> members;
  for (const BenchmarkGroup& group : groups) {
    if (group.first.objects != objects || group.first.method != method || group.seeds.empty()) continue;
    members.push_back(&group);
    for (const FigureSummary& figure : group.figures) {
      if (std::find(names.begin(), names.end(), figure.name) == names.end()) names.push_back(figure.name);
    }
  }
  summary.groups = static_cast<int>(members.size());
  for (const std::string& name : names) {
    std::vector<double> medians;
    for (const BenchmarkGroup* group : members) {
      const double value = medianOf(*group, name);
      if (std::isfinite(value)) medians.push_back(value);
    }
    summary.means.emplace_back(name, mean(medians));
  }
  return summary;
}

double wrongClosures(const std::vector<BenchmarkRun>& runs, const std::string& objects, const std::string& method) {
  double sum = 0.0;
  for (const BenchmarkRun& run : runs) {
    const double wrong = figureOf(run.figures, "closures_wrong");
    if (run.objects == objects && run.method == method && std::isfinite(wrong)) sum += wrong;
  }
  return sum;
}

}  // namespace

double figureOf(const Figures& figures, const std::string& name) {
  for (const auto& [known, value] : figures) {
    if (known == name) return value;
  }
  return kUndefined;
}

double medianOf(const BenchmarkGroup& group, const std::string& name) {
  for (const FigureSummary& figure : group.figures) {
    if (figure.name == name) return figure.median;
  }
  return kUndefined;
}

std::vector<BenchmarkGroup> groupRuns(const std::vector<BenchmarkRun>& runs) {
  std::vector<std::vector<const BenchmarkRun*>> members;
  for (const BenchmarkRun& run : runs) {
    const auto found = std::find_if(members.begin(), members.end(), [&](const auto& group) {
      return isSameCase(*group.front(), run) && group.front()->method == run.method;
    });
    if (found == members.end()) {
      members.push_back({&run});
    } else {
      found->push_back(&run);
    }
  }
  std::vector<BenchmarkGroup> groups;
  for (const auto& group : members) groups.push_back(makeGroup(group));
  return groups;
}

const BenchmarkGroup* groupOf(const std::vector<BenchmarkGroup>& groups, const BenchmarkGroup& like,
                              const std::string& method) {
  for (const BenchmarkGroup& group : groups) {
    if (isSameCase(group.first, like.first) && group.first.method == method && !group.seeds.empty()) return &group;
  }
  return nullptr;
}

std::vector<MethodSummary> summarizeMethods(const std::vector<BenchmarkRun>& runs) {
  const std::vector<BenchmarkGroup> groups = groupRuns(runs);
  std::vector<MethodSummary> result;
  for (const BenchmarkGroup& group : groups) {
    const bool is_known = std::any_of(result.begin(), result.end(), [&](const MethodSummary& known) {
      return known.objects == group.first.objects && known.method == group.first.method;
    });
    if (is_known) continue;
    MethodSummary summary = summarizeMethod(groups, group.first.objects, group.first.method);
    summary.wrong_closures = wrongClosures(runs, summary.objects, summary.method);
    result.push_back(std::move(summary));
  }
  return result;
}

}  // namespace semantic_mht_slam
