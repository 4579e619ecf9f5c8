#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/rigid_alignment.h"
#include "semantic_mht_slam/evaluation/svg_plot.h"
#include "semantic_mht_slam/evaluation/trajectory_error.h"
#include "semantic_mht_slam/evaluation/trajectory_plot.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/io/trajectory_file.h"

#include "evaluate_commands.h"
#include "evaluate_files.h"
#include "program.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

constexpr const char* kTrajectoryUsage =
    "Errors of trajectories against the truth, in KITTI format with a row a frame.\n"
    "An estimate FILE.tum is in TUM format, of the base frame; its poses are scored whose stamps are in times.txt "
    "beside\n"
    "the truth, where calib.txt has to be, too. With a truth FILE.tum, of the base frame as well, all are in TUM "
    "format,\n"
    "and an estimate is scored at the stamps of the truth, between its poses that are less than a second apart.\n"
    "\n"
    "usage: evaluate trajectory --truth poses.txt --estimate FILE [--estimate FILE ...] [--json] [--output DIR]\n"
    "\n"
    "  first    RMSE of the positions with the first poses made equal, m\n"
    "  se3      RMSE after a rigid least-squares alignment, m\n"
    "  running  mean and standard deviation over the frames of the RMSE up to the frame, unaligned, m\n"
    "  t_rel    translation error over 100..800 m of driving, %; r_rel: rotation error, deg/100 m\n"
    "  revisit  median error of the relative translation between visits of the same place, m\n";

constexpr std::size_t kNameColumns = 40;
constexpr double kMaxGap_s = 1.0;

struct Run {
  std::string path;
  std::string label;                 ///< tells the runs apart in plots and columns
  std::vector<std::size_t> numbers;  ///< of the frames that it has a pose of, rising; the lists below are as long
  std::vector<PoseMatrix> truth;
  std::vector<PoseMatrix> poses;
  TrajectoryError error;
  FrameErrors frames;
};

std::vector<Eigen::Vector3d> positionsOf(const std::vector<PoseMatrix>& poses) {
  std::vector<Eigen::Vector3d> positions_m;
  for (const PoseMatrix& pose : poses) positions_m.emplace_back(pose.translation());
  return positions_m;
}

std::string lastParts(const std::filesystem::path& path, int parts) {
  std::filesystem::path result = path.stem();
  std::filesystem::path folder = path.parent_path();
  for (int i = 1; i < parts && folder.has_filename(); ++i, folder = folder.parent_path()) {
    result = folder.filename() / result;
  }
  return result.string();
}

/// The file names, with as many folders before them as it takes to tell them apart.
std::vector<std::string> labels(const std::vector<std::string>& paths) {
  constexpr int kMaxParts = 8;
  std::vector<std::string> result;
  for (int parts = 1; parts <= kMaxParts; ++parts) {
    result.clear();
    for (const std::string& path : paths) result.push_back(lastParts(path, parts));
    if (std::set<std::string>(result.begin(), result.end()).size() == paths.size()) return result;
  }
  for (std::size_t i = 0; i < result.size(); ++i) result[i] += " " + std::to_string(i + 1);
  return result;
}

bool isTum(const std::string& path) {
  return std::filesystem::path(path).extension() == ".tum";
}

/// The poses of a TUM file whose stamps times.txt has, as those of camera 0.
void readTum(const std::string& truth_path, std::size_t frames, Run& run) {
  const Pose T_cam0_base = readCalibration(calibrationBeside(truth_path));
  const std::string times_path = (std::filesystem::path(truth_path).parent_path() / "times.txt").string();
  const std::vector<Stamp> stamps = readTimes(times_path);
  requireSameLength(truth_path, frames, times_path, stamps.size());
  std::vector<Pose> poses;
  for (const auto& [stamp, T_map_base] : readTumTrajectory(run.path)) {
    const auto found = std::lower_bound(stamps.begin(), stamps.end(), stamp);
    if (found == stamps.end() || *found != stamp) continue;
    run.numbers.push_back(static_cast<std::size_t>(found - stamps.begin()));
    poses.push_back(toCamera(T_map_base, T_cam0_base));
  }
  if (poses.empty()) throw InputError(run.path + ": none of its stamps is in " + times_path);
  run.poses = poseMatrices(poses);
}

/// The estimate between its poses at the stamps of a truth in TUM format.
void readTumAt(const std::vector<StampedPose>& truth, const std::string& truth_path, Run& run) {
  if (!isTum(run.path)) throw InputError(run.path + ": no .tum file, but the truth " + truth_path + " is one");
  const std::vector<StampedPose> estimate = readTumTrajectory(run.path);
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const Stamp stamp = truth[i].stamp;
    const auto next = std::lower_bound(estimate.begin(), estimate.end(), stamp,
                                       [](const StampedPose& pose, Stamp s) { return pose.stamp < s; });
    if (next == estimate.end() || (next == estimate.begin() && next->stamp != stamp)) continue;
    const auto before = next->stamp == stamp ? next : std::prev(next);
    const Stamp gap = next->stamp - before->stamp;
    if (secondsFromStamp(gap) > kMaxGap_s) continue;
    const double fraction = gap == 0 ? 0.0 : static_cast<double>(stamp - before->stamp) / static_cast<double>(gap);
    run.numbers.push_back(i);
    poses.push_back(interpolate(before->T_world_base, next->T_world_base, fraction));
  }
  if (poses.empty()) throw InputError(run.path + ": has no poses at the stamps of " + truth_path);
  run.poses = poseMatrices(poses);
}

void readKitti(const std::string& truth_path, std::size_t frames, Run& run) {
  run.poses = readPoseMatrices(run.path);
  requireSameLength(truth_path, frames, run.path, run.poses.size());
  for (std::size_t i = 0; i < frames; ++i) run.numbers.push_back(i);
}

/// The truth, and its stamps if it has any.
struct Truth {
  std::string path;
  std::vector<PoseMatrix> poses;
  std::vector<StampedPose> stamped;
};

Truth readTruth(const std::string& path) {
  if (!isTum(path)) return {path, readPoseMatrices(path), {}};
  Truth truth{path, {}, readTumTrajectory(path)};
  std::vector<Pose> poses;
  for (const StampedPose& pose : truth.stamped) poses.push_back(pose.T_world_base);
  truth.poses = poseMatrices(poses);
  return truth;
}

void readRun(const Truth& truth, Run& run) {
  if (!truth.stamped.empty()) return readTumAt(truth.stamped, truth.path, run);
  (isTum(run.path) ? readTum : readKitti)(truth.path, truth.poses.size(), run);
}

std::vector<Run> evaluateRuns(const Truth& truth, const std::vector<std::string>& paths) {
  const std::vector<std::string> names = labels(paths);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    Run run;
    run.path = paths[i];
    run.label = names[i];
    readRun(truth, run);
    for (const std::size_t number : run.numbers) run.truth.push_back(truth.poses[number]);
    run.error = trajectoryError(run.truth, run.poses);
    run.frames = frameErrors(run.truth, run.poses);
    runs.push_back(std::move(run));
  }
  return runs;
}

nlohmann::json toJson(const Run& run) {
  nlohmann::json json = {{"frames", run.numbers.size()}, {"length_m", pathLength(run.truth)}};
  for (const auto& [name, value] : namedFigures(run.error)) json[name] = value;
  return json;
}

nlohmann::json toJson(const std::vector<Run>& runs) {
  nlohmann::json json = nlohmann::json::object();
  for (const Run& run : runs) json[run.path] = toJson(run);
  return json;
}

std::string leftAligned(std::string text, std::size_t width) {
  text.resize(std::max(text.size(), width), ' ');
  return text;
}

std::string table(const std::vector<Run>& runs) {
  std::string text = leftAligned("estimate", kNameColumns) + padded("first", 8) + padded("se3", 8) +
                     padded("running", 15) + padded("t_rel%", 8) + padded("r_rel", 8) + padded("revisit", 9) + "\n";
  for (const Run& run : runs) {
    const TrajectoryError& e = run.error;
    const std::string name = run.path.substr(run.path.size() - std::min(run.path.size(), kNameColumns));
    text += leftAligned(name, kNameColumns) + padded(figure(e.first_m, 2), 8) + padded(figure(e.se3_m, 2), 8) +
            padded(figure(e.running_mean_m, 2), 8) + "\u00b1" + leftAligned(figure(e.running_std_m, 2), 6) +
            padded(figure(e.t_rel_percent, 2), 8) + padded(figure(e.r_rel_deg_per_100m, 2), 8) +
            padded(figure(e.revisit_m, 2), 9) + "\n";
  }
  return text;
}

/// The cells of a run, a text a frame; empty cells where it has no pose.
std::vector<std::string> errorCells(const Run& run, std::size_t frames) {
  const Pose T_truth_estimate = rigidAlignment(positionsOf(run.poses), positionsOf(run.truth));
  std::vector<std::string> cells(frames, ",,,,,,");
  for (std::size_t i = 0; i < run.numbers.size(); ++i) {
    const Eigen::Vector3d aligned_m = T_truth_estimate * Eigen::Vector3d(run.poses[i].translation());
    std::string& text = cells[run.numbers[i]];
    text.clear();
    for (const double value : {run.frames.unaligned_m[i], run.frames.aligned_m[i], run.frames.running_rmse_m[i],
                               aligned_m.x(), aligned_m.y(), aligned_m.z()}) {
      text += "," + formatFixed(value, 6);
    }
  }
  return cells;
}

std::string errorsCsv(const std::vector<Run>& runs, std::size_t frames) {
  std::string header = "frame";
  std::vector<std::string> rows(frames);
  for (std::size_t i = 0; i < frames; ++i) rows[i] = std::to_string(i);
  for (const Run& run : runs) {
    std::string label = run.label;
    std::replace(label.begin(), label.end(), ',', '_');
    for (const char* column :
         {"_unaligned_m", "_aligned_m", "_running_rmse_m", "_aligned_x_m", "_aligned_y_m", "_aligned_z_m"}) {
      header.append(",").append(label).append(column);
    }
    const std::vector<std::string> cells = errorCells(run, frames);
    for (std::size_t i = 0; i < frames; ++i) rows[i] += cells[i];
  }
  return header + "\n" + joined(rows, "\n") + "\n";
}

OutputFiles files(const std::vector<PoseMatrix>& truth, const std::vector<Run>& runs) {
  std::vector<NamedPath> paths = {{"truth", positionsOf(truth)}};
  std::vector<NamedErrors> errors;
  for (const Run& run : runs) {
    paths.push_back({run.label, positionsOf(startingAt(run.truth.front(), run.poses))});
    errors.push_back({run.label, {run.numbers.begin(), run.numbers.end()}, run.frames.running_rmse_m});
  }
  return {{"trajectory.json", jsonText(toJson(runs))},
          {"trajectory_errors.csv", errorsCsv(runs, truth.size())},
          {"trajectory.svg", svgPlot(trajectoryPlot(paths))},
          {"running_rmse.svg", svgPlot(errorPlot("Error up to the frame, unaligned", "RMSE [m]", errors))}};
}

}  // namespace

int evaluateTrajectory(const std::vector<std::string>& arguments) {
  std::string truth_path;
  std::string folder;
  std::vector<std::string> paths;
  bool as_json = false;
  po::options_description options("options");
  options.add_options()("truth", po::value(&truth_path)->required(), "true poses")(
      "estimate", po::value(&paths)->required()->multitoken()->composing(), "estimated poses, one or more files")(
      "json", po::bool_switch(&as_json), "print JSON in place of a table")(
      "output", po::value(&folder),
      "folder for trajectory.json, trajectory_errors.csv, trajectory.svg and running_rmse.svg");
  if (!parseOrHelp(arguments, kTrajectoryUsage, options)) return 0;

  const Truth truth = readTruth(truth_path);
  const std::vector<Run> runs = evaluateRuns(truth, paths);
  report(as_json, toJson(runs), table(runs), folder, folder.empty() ? OutputFiles{} : files(truth.poses, runs));
  return 0;
}

}  // namespace semantic_mht_slam
