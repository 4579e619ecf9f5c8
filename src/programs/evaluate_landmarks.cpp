#include <cmath>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/evaluation/landmark_error.h"
#include "semantic_mht_slam/evaluation/rigid_alignment.h"
#include "semantic_mht_slam/evaluation/svg_plot.h"
#include "semantic_mht_slam/evaluation/trajectory_error.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"
#include "semantic_mht_slam/io/yaml_file.h"

#include "evaluate_commands.h"
#include "evaluate_files.h"
#include "evaluate_landmark_files.h"
#include "evaluate_landmark_sightings.h"
#include "program.h"

namespace semantic_mht_slam {
namespace {

namespace po = boost::program_options;

constexpr const char* kLandmarksUsage =
    "Mapped landmarks against true ones, matched one to one within a radius in the plane.\n"
    "\n"
    "usage: evaluate landmarks --truth landmarks.csv --landmarks landmarks.csv [--radius R] [--class NAME ...]\n"
    "           [--ignore-class] [--poses poses.txt [--calib calib.txt] [--trajectory trajectory.txt] [--align se3]]\n"
    "           [--objects objects.csv [--min-frames N]] [--json] [--output DIR]\n"
    "\n"
    "Both files hold columns x,y and optionally z,class in metres, or are rows x,y[,z] without a header. The truth is "
    "in\n"
    "the Velodyne frame of the first true pose. With --poses ghosts are counted per kilometre; with --trajectory the "
    "map\n"
    "is moved by the alignment of the trajectory that it was made along. With --objects, true landmarks that fewer\n"
    "than N frames show (an object within the radius) count neither as missed nor as ghosts.\n";

struct LandmarksOptions {
  std::string truth_path;
  std::string map_path;
  std::string poses_path;
  std::string trajectory_path;
  std::string calibration_path;
  std::string alignment;
  std::string folder;
  std::string objects_path;
  std::string table_path;
  std::vector<std::string> classes;
  double radius_m = 1.0;
  int min_frames = 5;
  bool ignore_class = false;
  bool as_json = false;
};

std::vector<Eigen::Vector3d> positions(const std::vector<Pose>& poses) {
  std::vector<Eigen::Vector3d> result;
  result.reserve(poses.size());
  for (const Pose& pose : poses) result.push_back(pose.translation_m);
  return result;
}

/// The true drive, and where its Velodyne was.
struct TrueDrive {
  double length_m = 0.0;
  Pose T_cam0_velodyne;                ///< with `T_truth_velodyne`, empty unless something needs the Velodyne
  std::vector<Pose> T_truth_velodyne;  ///< in the frame of the true landmarks, which is the first of them
};

bool needsVelodyne(const LandmarksOptions& options) {
  return !options.objects_path.empty() || (!options.trajectory_path.empty() && options.alignment != "none");
}

TrueDrive readDrive(const LandmarksOptions& options) {
  const std::vector<Pose> T_world_cam0 = readKittiTrajectory(options.poses_path);
  TrueDrive drive;
  drive.length_m = pathLength(poseMatrices(T_world_cam0));
  if (!needsVelodyne(options)) return drive;
  drive.T_cam0_velodyne = readCalibration(options.calibration_path.empty() ? calibrationBeside(options.poses_path)
                                                                           : options.calibration_path);
  drive.T_truth_velodyne = inVelodyneFrame(T_world_cam0, drive.T_cam0_velodyne);
  const Pose T_truth_world = drive.T_truth_velodyne.front().inverse();
  for (Pose& pose : drive.T_truth_velodyne) pose = T_truth_world * pose;
  return drive;
}

/// From the frame of the map to that of the true landmarks, by the trajectories of the Velodyne in both.
Pose alignment(const LandmarksOptions& options, const TrueDrive& drive) {
  if (options.trajectory_path.empty() || options.alignment == "none") return Pose::identity();
  const std::vector<Pose> estimate_cam0 = readKittiTrajectory(options.trajectory_path);
  const std::vector<Pose>& truth = drive.T_truth_velodyne;
  requireSameLength(options.poses_path, truth.size(), options.trajectory_path, estimate_cam0.size());
  const std::vector<Eigen::Vector3d> true_m = positions(truth);
  const std::vector<Eigen::Vector3d> estimated_m = positions(inVelodyneFrame(estimate_cam0, drive.T_cam0_velodyne));
  return options.alignment == "se2" ? planarAlignment(estimated_m, true_m) : rigidAlignment(estimated_m, true_m);
}

LandmarkComparison comparison(const LandmarksOptions& options, const TrueDrive& drive) {
  LandmarkComparison result;
  result.radius_m = options.radius_m;
  result.match_class = !options.ignore_class;
  if (options.poses_path.empty()) return result;
  if (drive.length_m > 0.0) result.driven_length_m = drive.length_m;
  result.T_truth_map = alignment(options, drive);
  return result;
}

nlohmann::json toJson(const LandmarkError& error) {
  return {{"true_landmarks", error.true_landmarks},
          {"mapped_landmarks", error.mapped_landmarks},
          {"matches", error.matches.size()},
          {"duplicates", error.duplicates},
          {"ghosts", error.ghosts},
          {"recall", error.recall},
          {"precision", error.precision},
          {"duplicates_per_true", error.duplicates_per_true},
          {"ghosts_per_km", error.ghosts_per_km},
          {"rmse_m", error.rmse_m},
          {"median_m", error.median_m},
          {"height_rmse_m", error.height_rmse_m}};
}

std::string table(const LandmarkError& error) {
  return "landmarks " + std::to_string(error.mapped_landmarks) + " mapped, " + std::to_string(error.true_landmarks) +
         " true, " + std::to_string(error.matches.size()) + " matched; recall " + figure(error.recall, 3) +
         " precision " + figure(error.precision, 3) + "\n" + "duplicates " + std::to_string(error.duplicates) + " = " +
         figure(error.duplicates_per_true, 3) + " per true landmark; ghosts " + std::to_string(error.ghosts) + " = " +
         figure(error.ghosts_per_km, 2) + " per km\n" + "position RMSE " + figure(error.rmse_m, 3) + " m, median " +
         figure(error.median_m, 3) + " m; height RMSE " + figure(error.height_rmse_m, 3) + " m\n";
}

std::string matchesCsv(const LandmarkError& error, const NumberedLandmarks& truth, const NumberedLandmarks& map) {
  std::string text = "truth,landmark,distance_m\n";
  for (const LandmarkMatch& match : error.matches) {
    text += std::to_string(truth.ids[match.truth]) + "," + std::to_string(map.ids[match.mapped]) + "," +
            formatFixed(match.distance_m, 6) + "\n";
  }
  return text;
}

PlotSeries dots(const std::string& label, const NumberedLandmarks& landmarks, const Pose& T_truth_source) {
  PlotSeries series;
  series.label = label;
  series.style = PlotSeries::Style::kDots;
  for (const PointLandmark& landmark : landmarks.landmarks) {
    const Eigen::Vector3d position_m = T_truth_source * landmark.position_m;
    series.x.push_back(position_m.x());
    series.y.push_back(position_m.y());
  }
  return series;
}

std::string mapPlot(const NumberedLandmarks& truth, const NumberedLandmarks& map, const Pose& T_truth_map) {
  Plot plot;
  plot.title = "Landmarks";
  plot.x_label = "x [m]";
  plot.y_label = "y [m]";
  plot.equal_aspect = true;
  plot.series = {dots("truth", truth, Pose::identity()), dots("map", map, T_truth_map)};
  plot.series.front().color = "#333333";
  return svgPlot(plot);
}

po::options_description describe(LandmarksOptions& values) {
  po::options_description options("options");
  options.add_options()("truth", po::value(&values.truth_path)->required(), "true landmarks")(
      "landmarks", po::value(&values.map_path)->required(), "mapped landmarks")(
      "radius", po::value(&values.radius_m)->default_value(1.0, "1"), "largest distance of a match, m")(
      "class", po::value(&values.classes)->multitoken()->composing(), "compare landmarks of these classes alone")(
      "ignore-class", po::bool_switch(&values.ignore_class), "match landmarks of different classes, too")(
      "poses", po::value(&values.poses_path), "true poses, KITTI format")(
      "trajectory", po::value(&values.trajectory_path), "estimated poses of the map's run, KITTI format")(
      "calib", po::value(&values.calibration_path), "calibration; default: calib.txt beside the poses")(
      "align", po::value(&values.alignment)->default_value("se3"), "se3, se2 or none")(
      "objects", po::value(&values.objects_path), "objects CSV of the run, Velodyne frame")(
      "min-frames", po::value(&values.min_frames)->default_value(5), "frames that must show a landmark")(
      "class-table", po::value(&values.table_path)->default_value(packageConfigFile("classes_semantic_kitti.yaml")),
      "classes of the objects")("json", po::bool_switch(&values.as_json), "print JSON in place of a table")(
      "output", po::value(&values.folder), "folder for landmarks.json, landmark_matches.csv and landmarks.svg");
  return options;
}

void check(const LandmarksOptions& options) {
  if (!(options.radius_m > 0.0) || !std::isfinite(options.radius_m)) throw InputError("--radius must be positive");
  if (options.alignment != "se3" && options.alignment != "se2" && options.alignment != "none") {
    throw InputError("--align is '" + options.alignment + "', one of se3, se2 and none was expected");
  }
  if (!options.trajectory_path.empty() && options.poses_path.empty()) throw InputError("--trajectory needs --poses");
  if (!options.objects_path.empty() && options.poses_path.empty()) throw InputError("--objects needs --poses");
  if (options.min_frames < 1) throw InputError("--min-frames must be at least 1");
}

/// Without those that hardly a frame shows.
NumberedLandmarks seenOnes(const LandmarksOptions& options, const TrueDrive& drive, const NumberedLandmarks& truth) {
  const std::vector<int> frames =
      framesThatShow(truth.landmarks, options.objects_path, readClassTable(options.table_path), options.classes,
                     drive.T_truth_velodyne, options.radius_m);
  NumberedLandmarks result;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (frames[i] < options.min_frames) continue;
    result.ids.push_back(truth.ids[i]);
    result.landmarks.push_back(truth.landmarks[i]);
  }
  return result;
}

}  // namespace

int evaluateLandmarks(const std::vector<std::string>& arguments) {
  LandmarksOptions options;
  if (!parseOrHelp(arguments, kLandmarksUsage, describe(options))) return 0;
  check(options);
  const NumberedLandmarks all = readLandmarks(options.truth_path, options.classes);
  const TrueDrive drive = options.poses_path.empty() ? TrueDrive{} : readDrive(options);
  const NumberedLandmarks truth = options.objects_path.empty() ? all : seenOnes(options, drive, all);
  const NumberedLandmarks map = readLandmarks(options.map_path, options.classes);
  const LandmarkComparison how = comparison(options, drive);
  LandmarkError error = landmarkError(truth.landmarks, map.landmarks, how);
  if (!options.objects_path.empty()) {  // what stands at a landmark that is hardly seen is no ghost
    const LandmarkError of_all = landmarkError(all.landmarks, map.landmarks, how);
    error.ghosts = of_all.ghosts;
    error.ghosts_per_km = of_all.ghosts_per_km;
    error.precision = of_all.precision;
  }
  const nlohmann::json json = toJson(error);
  OutputFiles files = {{"landmarks.json", jsonText(json)}};
  if (!options.folder.empty()) {
    files.emplace_back("landmark_matches.csv", matchesCsv(error, truth, map));
    files.emplace_back("landmarks.svg", mapPlot(truth, map, how.T_truth_map));
  }
  report(options.as_json, json, table(error), options.folder, files);
  return 0;
}

}  // namespace semantic_mht_slam
