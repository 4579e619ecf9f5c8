#include "evaluate_files.h"

#include <cmath>
#include <filesystem>
#include <iostream>
#include <stdexcept>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/io/text_file.h"
#include "semantic_mht_slam/io/trajectory_file.h"

namespace semantic_mht_slam {

std::vector<PoseMatrix> readPoseMatrices(const std::string& path) {
  const std::size_t rows = readKittiTrajectory(path).size();  // every check of the format
  std::vector<PoseMatrix> poses;
  poses.reserve(rows);
  forEachLine(readFile(path), [&](int line, std::string_view text) {
    const std::vector<std::string_view> cells = splitBlanks(text);
    PoseMatrix pose = PoseMatrix::Identity();
    for (std::size_t i = 0; i < cells.size(); ++i) {
      const std::optional<double> value = parseDouble(cells[i]);
      if (!value || i >= 12) throw InputError(at(path, line) + ": changed while it was read");
      pose.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) = *value;
    }
    poses.push_back(pose);
  });
  return poses;
}

void requireSameLength(const std::string& truth_path, std::size_t truth_poses, const std::string& path,
                       std::size_t poses) {
  if (truth_poses == poses) return;
  throw InputError(path + ": " + std::to_string(poses) + " poses, the truth " + truth_path + " has " +
                   std::to_string(truth_poses));
}

std::vector<Pose> inVelodyneFrame(const std::vector<Pose>& T_world_cam0, const Pose& T_cam0_velodyne) {
  std::vector<Pose> result;
  result.reserve(T_world_cam0.size());
  for (const Pose& pose : T_world_cam0) result.push_back(T_cam0_velodyne.inverse() * pose * T_cam0_velodyne);
  return result;
}

std::string calibrationBeside(const std::string& poses_path) {
  return (std::filesystem::path(poses_path).parent_path() / "calib.txt").string();
}

void withFileName(const std::string& path, const std::function<void()>& compute) {
  try {
    compute();
  } catch (const std::invalid_argument& problem) {
    throw InputError(path + ": " + problem.what());
  }
}

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? std::string(width - text.size(), ' ') + text : text;
}

std::string figure(double value, int decimals) {
  return std::isnan(value) ? "nan" : formatFixed(value, decimals);
}

void report(bool as_json, const nlohmann::json& json, const std::string& table, const std::string& folder,
            const OutputFiles& files) {
  if (!folder.empty()) {
    prepareOutputFolder(folder);
    for (const auto& [name, content] : files) {
      writeFileAtomically((std::filesystem::path(folder) / name).string(), content);
    }
  }
  std::cout << (as_json ? jsonText(json) : table);
}

std::string jsonText(const nlohmann::json& json) {
  return json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace semantic_mht_slam
