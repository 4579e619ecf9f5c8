#include "evaluate_benchmark_scores.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include <nlohmann/json.hpp>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/association_score.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "evaluate_files.h"
#include "evaluate_rows.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

constexpr double kUndefined = std::numeric_limits<double>::quiet_NaN();
constexpr double kBytesPerMb = 1e6;
constexpr double kMetresPerKm = 1000.0;

std::string inFolder(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

nlohmann::json readReport(const BenchmarkCell& cell) {
  const std::string path = inFolder(cell.folder, "report.json");
  nlohmann::json report = nlohmann::json::parse(readFile(path), nullptr, false);
  if (!report.is_object()) throw InputError(path + ": no JSON object");
  return report;
}

/// A number of a document by its path, as "/hypotheses/mean".
double numberAt(const nlohmann::json& json, const std::string& path) {
  const nlohmann::json::json_pointer pointer(path);
  return json.contains(pointer) && json[pointer].is_number() ? json[pointer].get<double>() : kUndefined;
}

void addErrors(const std::string& prefix, const TrajectoryError& error, Figures& figures) {
  for (const auto& [name, value] : namedFigures(error)) figures.emplace_back(prefix + name, value);
}

double reductionPercent(double value, double raw) {
  return 100.0 * (1.0 - value / raw);
}

/// Undefined figures where the run did not write its live estimate.
TrajectoryError onlineError(const BenchmarkCell& cell, const SequenceTruth& truth) {
  const OnlineTrajectory online = readOnline(cell, truth);
  return online.frames.empty() ? TrajectoryError{} : trajectoryError(online.truth, online.estimate);
}

void addClosures(const BenchmarkCell& cell, const SequenceTruth& truth, Figures& figures) {
  const std::string path = inFolder(cell.folder, "loop_closures.csv");
  std::vector<ClosureEstimate> closures;
  if (fs::exists(path)) closures = readClosures(path);
  const auto frames = static_cast<std::int64_t>(truth.stamps.size());
  for (const ClosureEstimate& closure : closures) {  // the refused ones too: they are drawn
    const auto [low, high] = std::minmax(closure.query_frame, closure.match_frame);
    if (low < 0 || high >= frames) throw InputError(path + ": a frame outside 0 to " + std::to_string(frames - 1));
  }
  ClosureScore score;
  withFileName(path, [&] { score = closureScore(truth.T_world_velodyne, closures); });
  figures.emplace_back("closures_checked", static_cast<double>(closures.size()));
  figures.emplace_back("closures_accepted", score.accepted);
  figures.emplace_back("closures_wrong", score.wrong);
  figures.emplace_back("closures_precision", score.accepted > 0 ? score.precision : kUndefined);
  figures.emplace_back("closures_recall", score.revisited_blocks > 0 ? score.recall : kUndefined);
}

/// The truth of the objects is beside them: objects.csv, objects_landmark.csv.
std::optional<AssociationScore> associationScoreOf(const BenchmarkCell& cell) {
  const fs::path objects = fs::path(cell.dataset) / cell.objects_file;
  const std::string truth_path =
      (objects.parent_path() / (objects.stem().string() + "_landmark" + objects.extension().string())).string();
  const std::string path = inFolder(cell.folder, "associations.csv");
  if (!fs::exists(truth_path)) return std::nullopt;
  const std::vector<AssociatedDetection> associations = readAssociations(path);
  if (associations.empty()) return std::nullopt;  // a method without a map
  std::optional<AssociationScore> score;
  withFileName(path, [&] { score = associationScore(readTrueDetections(truth_path), associations); });
  return score;
}

void addAssociations(const BenchmarkCell& cell, Figures& figures) {
  const std::optional<AssociationScore> score = associationScoreOf(cell);
  const auto add = [&](const std::string& name, double value) {
    figures.emplace_back(name, score ? value : kUndefined);
  };
  const AssociationScore values = score.value_or(AssociationScore{});
  add("association_local_precision", values.local.precision);
  add("association_local_recall", values.local.recall);
  add("association_local_f1", values.local.f1);
  add("association_all_precision", values.all.precision);
  add("association_all_recall", values.all.recall);
  add("association_all_f1", values.all.f1);
  add("clutter_accepted", values.clutter_accepted);
  add("static_rejected", values.static_rejected);
}

void addMapSize(const nlohmann::json& report, const SequenceTruth& truth, Figures& figures) {
  figures.emplace_back("hypotheses_mean", numberAt(report, "/hypotheses/mean"));
  figures.emplace_back("hypotheses_max", numberAt(report, "/hypotheses/max"));
  figures.emplace_back("landmarks", numberAt(report, "/landmarks"));
  figures.emplace_back("submaps", numberAt(report, "/submaps"));
  const double map_mb = numberAt(report, "/map_bytes") / kBytesPerMb;
  figures.emplace_back("map_mb", map_mb);
  figures.emplace_back("map_mb_per_km", map_mb / (truth.length_m / kMetresPerKm));
}

}  // namespace

SequenceTruth readTruth(const std::string& dataset) {
  SequenceTruth truth;
  truth.path = inFolder(dataset, "poses.txt");
  truth.T_world_cam0 = readPoseMatrices(truth.path);
  truth.T_cam0_velodyne = readCalibration(inFolder(dataset, "calib.txt"));
  truth.T_world_velodyne = inVelodyneFrame(readKittiTrajectory(truth.path), truth.T_cam0_velodyne);
  truth.stamps = readTimes(inFolder(dataset, "times.txt"));
  requireSameLength(inFolder(dataset, "times.txt"), truth.stamps.size(), truth.path, truth.T_world_cam0.size());
  truth.length_m = pathLength(truth.T_world_cam0);
  return truth;
}

const SequenceTruth& BenchmarkScorer::truthOf(const BenchmarkCell& cell) {
  const auto found = truths_.find(cell.dataset);
  if (found != truths_.end()) return found->second;
  return truths_.emplace(cell.dataset, readTruth(cell.dataset)).first->second;
}

const TrajectoryError& BenchmarkScorer::odometryError(const BenchmarkCell& cell) {
  const std::string path = inFolder(cell.dataset, odometryFile(cell.run.odometry));
  const auto found = odometry_errors_.find(path);
  if (found != odometry_errors_.end()) return found->second;
  const SequenceTruth& truth = truthOf(cell);
  const std::vector<PoseMatrix> odometry = readPoseMatrices(path);
  requireSameLength(truth.path, truth.T_world_cam0.size(), path, odometry.size());
  return odometry_errors_.emplace(path, trajectoryError(truth.T_world_cam0, odometry)).first->second;
}

Figures BenchmarkScorer::figuresOf(const BenchmarkCell& cell) {
  const SequenceTruth& truth = truthOf(cell);
  const TrajectoryError& raw = odometryError(cell);
  const TrajectoryError error = trajectoryError(truth.T_world_cam0, readResult(cell));
  const nlohmann::json report = readReport(cell);
  Figures figures = {{"frames", numberAt(report, "/frames")}, {"length_m", truth.length_m}};
  addErrors("", error, figures);
  addErrors("online_", onlineError(cell, truth), figures);
  addErrors("raw_", raw, figures);
  figures.emplace_back("reduction_se3_percent", reductionPercent(error.se3_m, raw.se3_m));
  figures.emplace_back("reduction_running_percent", reductionPercent(error.running_mean_m, raw.running_mean_m));
  addClosures(cell, truth, figures);
  addAssociations(cell, figures);
  addMapSize(report, truth, figures);
  return figures;
}

Figures measuredOf(const BenchmarkCell& cell) {
  const nlohmann::json report = readReport(cell);
  return {{"seconds", numberAt(report, "/seconds")},
          {"ms_mean", numberAt(report, "/ms_per_frame/mean")},
          {"ms_p50", numberAt(report, "/ms_per_frame/p50")},
          {"ms_p95", numberAt(report, "/ms_per_frame/p95")},
          {"ms_p99", numberAt(report, "/ms_per_frame/p99")},
          {"ms_max", numberAt(report, "/ms_per_frame/max")},
          {"mapping_ms_mean", numberAt(report, "/mapping_ms_per_frame/mean")},
          {"mapping_ms_p99", numberAt(report, "/mapping_ms_per_frame/p99")},
          {"peak_rss_mb", numberAt(report, "/peak_rss_mb")}};
}

Histogram hypothesesOf(const BenchmarkCell& cell) {
  const nlohmann::json report = readReport(cell);
  const nlohmann::json::json_pointer path("/hypotheses/frames_with");
  Histogram histogram;
  if (!report.contains(path)) return histogram;
  for (const auto& [count, frames] : report[path].items()) {
    const std::optional<std::int64_t> hypotheses = parseInteger(count);
    if (hypotheses && frames.is_number()) histogram[static_cast<int>(*hypotheses)] = frames.get<double>();
  }
  return histogram;
}

std::vector<PoseMatrix> readResult(const BenchmarkCell& cell) {
  const std::string path = inFolder(cell.folder, "trajectory.txt");
  std::vector<PoseMatrix> poses = readPoseMatrices(path);
  const std::string times = inFolder(cell.dataset, "times.txt");
  requireSameLength(times, readTimes(times).size(), path, poses.size());
  return poses;
}

OnlineTrajectory readOnline(const BenchmarkCell& cell, const SequenceTruth& truth) {
  const std::string path = inFolder(cell.folder, "trajectory_online.tum");
  if (!fs::exists(path) || fs::file_size(path) == 0) return {};
  OnlineTrajectory online;
  std::vector<Pose> estimate;
  for (const auto& [stamp, T_map_base] : readTumTrajectory(path)) {
    const auto found = std::lower_bound(truth.stamps.begin(), truth.stamps.end(), stamp);
    if (found == truth.stamps.end() || *found != stamp) continue;
    const auto frame = static_cast<std::size_t>(found - truth.stamps.begin());
    online.frames.push_back(static_cast<double>(frame));
    online.truth.push_back(truth.T_world_cam0[frame]);
    estimate.push_back(toCamera(T_map_base, truth.T_cam0_velodyne));
  }
  if (estimate.empty()) throw InputError(path + ": no stamp of times.txt in it");
  online.estimate = poseMatrices(estimate);
  return online;
}

std::vector<std::pair<std::string, std::vector<PoseMatrix>>> readReferences(const std::string& dataset,
                                                                            const SequenceTruth& truth) {
  std::vector<std::pair<std::string, std::vector<PoseMatrix>>> references;
  const fs::path folder = fs::path(dataset) / "reference";
  if (!fs::is_directory(folder)) return references;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".txt") continue;
    std::vector<PoseMatrix> poses = readPoseMatrices(entry.path().string());
    requireSameLength(truth.path, truth.T_world_cam0.size(), entry.path().string(), poses.size());
    references.emplace_back(entry.path().stem().string(), std::move(poses));
  }
  std::sort(references.begin(), references.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  return references;
}

}  // namespace semantic_mht_slam
