#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "semantic_mht_slam/evaluation/category_plot.h"
#include "semantic_mht_slam/evaluation/rigid_alignment.h"
#include "semantic_mht_slam/evaluation/statistics.h"
#include "semantic_mht_slam/evaluation/svg_plot.h"
#include "semantic_mht_slam/evaluation/trajectory_plot.h"

#include "evaluate_benchmark_report.h"
#include "evaluate_files.h"
#include "evaluate_rows.h"

namespace semantic_mht_slam {
namespace {

constexpr double kInterruption = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kFullSystem = "dpmhm";
constexpr const char* kCheckedColor = "#e69f00";   // orange, as in the paper
constexpr const char* kAcceptedColor = "#009e73";  // green, as in the paper
constexpr const char* kRefusedColor = "#bbbbbb";
constexpr std::array<const char*, 3> kReferenceColors = {"#000000", "#8c564b", "#7f7f00"};
constexpr double kPercentStep = 0.001;  // smaller differences are noise of the last digits

using Positions = std::vector<Eigen::Vector3d>;

Positions positionsOf(const std::vector<PoseMatrix>& poses) {
  Positions positions;
  for (const PoseMatrix& pose : poses) positions.emplace_back(pose.translation());
  return positions;
}

Positions alignedTo(const Positions& truth_m, Positions positions_m) {
  const Pose T_truth_estimate = rigidAlignment(positions_m, truth_m);
  for (Eigen::Vector3d& position_m : positions_m) position_m = T_truth_estimate * position_m;
  return positions_m;
}

/// The run whose aligned error is nearest to the median of the seeds, the one with the smallest seed of several.
const BenchmarkCell& typicalCell(const BenchmarkResult& result, const BenchmarkGroup& group) {
  const double middle = medianOf(group, "se3_m");
  const std::vector<const BenchmarkCell*> cells = completeCells(result, group);
  return **std::min_element(cells.begin(), cells.end(), [&](const BenchmarkCell* a, const BenchmarkCell* b) {
    return std::abs(figureOf(a->run.figures, "se3_m") - middle) < std::abs(figureOf(b->run.figures, "se3_m") - middle);
  });
}

std::string caseName(const BenchmarkRun& run) {
  return run.sequence + ", " + run.odometry + ", " + run.kind + " objects";
}

const BenchmarkGroup* find(const std::vector<BenchmarkGroup>& part, const std::string& sequence,
                           const std::string& method) {
  const auto found = std::find_if(part.begin(), part.end(), [&](const BenchmarkGroup& group) {
    return group.first.sequence == sequence && group.first.method == method && !group.seeds.empty();
  });
  return found == part.end() ? nullptr : &*found;
}

PlotSeries overFrames(const std::string& label, const std::vector<double>& values, const std::string& color,
                      PlotSeries::Style style) {
  PlotSeries series{label, {}, values, color, style};
  for (std::size_t i = 0; i < values.size(); ++i) series.x.push_back(static_cast<double>(i));
  return series;
}

void addMethod(const BenchmarkMethod& method, const BenchmarkCell& cell, Plot& plot) {
  const SequenceTruth truth = readTruth(cell.dataset);
  const FrameErrors errors = frameErrors(truth.T_world_cam0, readResult(cell));
  plot.series.push_back(overFrames(method.name, errors.running_rmse_m, method.color, PlotSeries::Style::kLine));
  if (method.name != kFullSystem) return;
  const OnlineTrajectory online = readOnline(cell, truth);
  if (online.frames.empty()) return;
  PlotSeries series{method.name + " live", online.frames, {}, method.color, PlotSeries::Style::kDashed};
  series.y = frameErrors(online.truth, online.estimate).running_rmse_m;
  plot.series.push_back(std::move(series));
}

void addReferences(const std::vector<BenchmarkReference>& references, const std::string& sequence, Plot& plot) {
  std::size_t color = 0;
  for (const BenchmarkReference& reference : references) {
    if (reference.sequence != sequence) continue;
    plot.series.push_back(overFrames(reference.name, reference.running_rmse_m,
                                     kReferenceColors[color++ % kReferenceColors.size()], PlotSeries::Style::kDashed));
  }
}

Plot errorPlotOf(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part, const std::string& sequence) {
  Plot plot;
  plot.x_label = "frame";
  plot.y_label = "RMSE up to the frame, unaligned [m]";
  plot.y_from_zero = true;
  for (const BenchmarkMethod& method : benchmarkMethods()) {
    const BenchmarkGroup* group = find(part, sequence, method.name);
    if (group == nullptr) continue;
    plot.title = "RMSE over the frames: " + caseName(group->first);
    addMethod(method, typicalCell(result, *group), plot);
  }
  if (!plot.series.empty()) addReferences(result.references, sequence, plot);
  return plot;
}

Histogram hypothesesOf(const BenchmarkResult& result, const BenchmarkGroup& group) {
  Histogram sum;
  for (const BenchmarkCell* cell : completeCells(result, group)) {
    for (const auto& [hypotheses, frames] : hypothesesOf(*cell)) sum[hypotheses] += frames;
  }
  return sum;
}

std::string colorOf(const std::string& method) {
  for (const BenchmarkMethod& known : benchmarkMethods()) {
    if (known.name == method) return known.color;
  }
  return "";
}

std::optional<Plot> hypothesisPlot(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part) {
  const std::vector<std::string> sequences = sequencesOf(part);
  std::vector<ViolinSeries> violins;
  for (const std::string method : {"mhm", kFullSystem}) {
    ViolinSeries series{method, colorOf(method), {}};
    bool has_any = false;
    for (const std::string& sequence : sequences) {
      const BenchmarkGroup* group = find(part, sequence, method);
      series.histograms.push_back(group == nullptr ? Histogram{} : hypothesesOf(result, *group));
      has_any = has_any || !series.histograms.back().empty();
    }
    if (has_any) violins.push_back(std::move(series));
  }
  if (violins.empty()) return std::nullopt;
  return violinPlot("Hypotheses that live, over the frames: " + part.front().first.odometry, "hypotheses", sequences,
                    violins);
}

std::optional<Plot> ablationPlot(const std::vector<BenchmarkGroup>& part) {
  const std::vector<std::string> sequences = sequencesOf(part);
  std::vector<std::string> categories = sequences;
  categories.emplace_back("mean");
  std::vector<BarSeries> bars;
  for (const BenchmarkMethod& method : benchmarkMethods()) {
    if (method.method != kFullSystem) continue;
    BarSeries series{method.name, method.color, {}};
    std::vector<double> known;
    for (const std::string& sequence : sequences) {
      const BenchmarkGroup* group = find(part, sequence, method.name);
      const double percent = group == nullptr ? kInterruption : medianOf(*group, "reduction_se3_percent");
      series.values.push_back(kPercentStep * std::round(percent / kPercentStep));
      if (std::isfinite(series.values.back())) known.push_back(series.values.back());
    }
    series.values.push_back(mean(known));
    if (!known.empty()) bars.push_back(std::move(series));
  }
  if (bars.size() < 2) return std::nullopt;
  return barPlot("What classes and several hypotheses are worth: " + part.front().first.odometry,
                 "reduction of the SE3-aligned RMSE [%]", categories, bars);
}

void addPoint(const Eigen::Vector3d& position_m, PlotSeries& series) {
  series.x.push_back(position_m.x());
  series.y.push_back(position_m.z());
}

/// Lines between the frames of loop closures.
void addClosures(const BenchmarkCell& cell, const Positions& positions_m, Plot& plot) {
  PlotSeries refused{"refused", {}, {}, kRefusedColor, PlotSeries::Style::kLine};
  PlotSeries accepted{"loop closure", {}, {}, kAcceptedColor, PlotSeries::Style::kLine};
  PlotSeries closed{"", {}, {}, kAcceptedColor, PlotSeries::Style::kDots};
  for (const ClosureEstimate& closure : readClosures(cell.folder + "/loop_closures.csv")) {
    const Eigen::Vector3d& query_m = positions_m.at(static_cast<std::size_t>(closure.query_frame));
    const Eigen::Vector3d& match_m = positions_m.at(static_cast<std::size_t>(closure.match_frame));
    PlotSeries& lines = closure.accepted ? accepted : refused;
    addPoint(query_m, lines);
    addPoint(match_m, lines);
    addPoint(Eigen::Vector3d::Constant(kInterruption), lines);
    if (!closure.accepted) continue;
    addPoint(match_m, closed);
    addPoint(query_m, closed);
  }
  if (!refused.x.empty()) plot.series.insert(plot.series.begin(), refused);
  if (!accepted.x.empty()) plot.series.insert(plot.series.end(), {accepted, closed});
}

/// The way through the submaps that were searched for loop closures.
void addCheckedSubmaps(const BenchmarkCell& cell, const Positions& positions_m, Plot& plot) {
  PlotSeries checked{"checked submap", {}, {}, kCheckedColor, PlotSeries::Style::kLine};
  const std::vector<CheckedSubmap> submaps = readSubmaps(cell.folder + "/submaps.csv");
  for (std::size_t i = 0; i < submaps.size(); ++i) {
    if (!submaps[i].is_checked) continue;
    const bool is_last = i + 1 == submaps.size();
    const auto end = is_last ? positions_m.size() : static_cast<std::size_t>(submaps[i + 1].first_frame);
    for (auto k = static_cast<std::size_t>(submaps[i].first_frame); k < std::min(end, positions_m.size()); ++k) {
      addPoint(positions_m[k], checked);
    }
    addPoint(Eigen::Vector3d::Constant(kInterruption), checked);
  }
  if (!checked.x.empty()) plot.series.push_back(checked);
}

Plot mapPlotOf(const BenchmarkCell& cell) {
  const Positions truth_m = positionsOf(readTruth(cell.dataset).T_world_cam0);
  const Positions estimate_m = alignedTo(truth_m, positionsOf(readResult(cell)));
  const Positions odometry_m =
      alignedTo(truth_m, positionsOf(readPoseMatrices(cell.dataset + "/" + odometryFile(cell.run.odometry))));
  Plot plot = trajectoryPlot({{"truth", truth_m}, {"odometry", odometry_m}, {cell.run.method, estimate_m}},
                             GroundPlane::kXRightZForward);
  plot.title = caseName(cell.run) + ", seed " + std::to_string(cell.run.seed) + " (aligned)";
  plot.series[1].color = colorOf("odometry");
  plot.series[2].color = colorOf(cell.run.method);
  addCheckedSubmaps(cell, estimate_m, plot);
  addClosures(cell, estimate_m, plot);
  return plot;
}

}  // namespace

std::vector<std::string> errorPlots(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part) {
  std::vector<std::string> svgs;
  for (const std::string& sequence : sequencesOf(part)) {
    const Plot plot = errorPlotOf(result, part, sequence);
    if (!plot.series.empty()) svgs.push_back(svgPlot(plot));
  }
  return svgs;
}

std::vector<std::string> summaryPlots(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part) {
  std::vector<std::string> svgs;
  if (const std::optional<Plot> plot = hypothesisPlot(result, part)) svgs.push_back(svgPlot(*plot));
  if (const std::optional<Plot> plot = ablationPlot(part)) svgs.push_back(svgPlot(*plot));
  return svgs;
}

std::vector<std::string> mapPlots(const BenchmarkResult& result, const std::vector<BenchmarkGroup>& part) {
  std::vector<std::string> svgs;
  for (const std::string& sequence : sequencesOf(part)) {
    const BenchmarkGroup* group = find(part, sequence, kFullSystem);
    if (group != nullptr) svgs.push_back(svgPlot(mapPlotOf(typicalCell(result, *group))));
  }
  return svgs;
}

}  // namespace semantic_mht_slam
