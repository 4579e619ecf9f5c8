#include "semantic_mht_slam/io/dataset.h"

#include <filesystem>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/io/calibration_file.h"
#include "semantic_mht_slam/io/existing_path.h"
#include "semantic_mht_slam/io/fixes_file.h"
#include "semantic_mht_slam/io/objects_file.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

namespace semantic_mht_slam {
namespace {

namespace fs = std::filesystem;

std::string inside(const std::string& folder, const std::string& name) {
  return (fs::path(folder) / name).string();
}

/// A file that the user named: inside the folder if it is there, else as it stands.
std::string locate(const std::string& folder, const std::string& name) {
  const std::string in_folder = inside(folder, name);
  return fs::path(name).is_absolute() || (!mayExist(in_folder) && mayExist(name)) ? name : in_folder;
}

std::vector<Pose> readPoses(const std::string& path, const Pose& T_cam0_base, std::size_t frames) {
  std::vector<Pose> poses = readKittiTrajectory(path);
  if (poses.size() != frames) {
    throw InputError(path + ": " + std::to_string(poses.size()) + " poses, times.txt has " + std::to_string(frames) +
                     " rows");
  }
  for (Pose& pose : poses) pose = toBase(pose, T_cam0_base);
  return poses;
}

std::string formatPoses(std::vector<Pose> poses, const Pose& T_cam0_base) {
  for (Pose& pose : poses) pose = toCamera(pose, T_cam0_base);
  return formatKittiTrajectory(poses);
}

}  // namespace

Pose toBase(const Pose& T_world_cam0, const Pose& T_cam0_base) {
  return T_cam0_base.inverse() * T_world_cam0 * T_cam0_base;
}

Pose toCamera(const Pose& T_world_base, const Pose& T_cam0_base) {
  return T_cam0_base * T_world_base * T_cam0_base.inverse();
}

Dataset readDataset(const DatasetFiles& files, const ClassTable& classes) {
  if (!isFolder(files.folder)) throw InputError("no data-set folder '" + files.folder + "'");
  Dataset dataset;
  dataset.stamps = readTimes(inside(files.folder, "times.txt"));
  dataset.T_cam0_base = readCalibration(inside(files.folder, "calib.txt"));
  dataset.T_odom_base = readPoses(locate(files.folder, files.odometry), dataset.T_cam0_base, dataset.frames());
  dataset.detections.resize(dataset.frames());
  if (!files.objects.empty()) {
    ObjectsFile objects = readObjects(locate(files.folder, files.objects), classes, dataset.frames());
    dataset.detections = std::move(objects.detections);
    dataset.notice = std::move(objects.notice);
  }
  if (!files.fixes.empty()) {
    FixesFile fixes = readFixes(locate(files.folder, files.fixes));
    dataset.fixes = std::move(fixes.fixes);
    dataset.fixes_notice = std::move(fixes.notice);
  }
  const std::string truth = (fs::path(files.folder) / "poses.txt").string();
  if (mayExist(truth)) dataset.T_map_base = readPoses(truth, dataset.T_cam0_base, dataset.frames());
  return dataset;
}

void writeDataset(const Dataset& dataset, const ClassTable& classes, const std::string& folder) {
  const fs::path root(folder);
  prepareOutputFolder((root / "odometry").string());
  writeFileAtomically((root / "times.txt").string(), formatTimes(dataset.stamps));
  writeFileAtomically((root / "calib.txt").string(), formatCalibration(dataset.T_cam0_base));
  writeFileAtomically((root / "odometry" / "odometry.txt").string(),
                      formatPoses(dataset.T_odom_base, dataset.T_cam0_base));
  writeFileAtomically((root / "objects.csv").string(), formatObjects(dataset.detections, classes));
  if (dataset.T_map_base) {
    writeFileAtomically((root / "poses.txt").string(), formatPoses(*dataset.T_map_base, dataset.T_cam0_base));
  }
}

}  // namespace semantic_mht_slam
