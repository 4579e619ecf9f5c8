#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/evaluation/trajectory_error.h"

namespace semantic_mht_slam {

/// A trajectory in KITTI format with every digit of its matrices; refuses what `readKittiTrajectory` refuses.
std::vector<PoseMatrix> readPoseMatrices(const std::string& path);

/// Throws InputError naming both files unless they have as many poses.
void requireSameLength(const std::string& truth_path, std::size_t truth_poses, const std::string& path,
                       std::size_t poses);

/// T_world_velodyne in the axes of the Velodyne, from a trajectory of the camera.
std::vector<Pose> inVelodyneFrame(const std::vector<Pose>& T_world_cam0, const Pose& T_cam0_velodyne);

/// calib.txt in the folder of `poses_path`.
std::string calibrationBeside(const std::string& poses_path);

/// Runs `compute`; what it finds wrong with values of a file becomes an InputError that names the file.
void withFileName(const std::string& path, const std::function<void()>& compute);

/// Right-aligned in `width` columns.
std::string padded(const std::string& text, std::size_t width);

/// A number with fixed decimals, or "nan".
std::string figure(double value, int decimals);

/// Name and content of the files that a command writes.
using OutputFiles = std::vector<std::pair<std::string, std::string>>;

/// Prints `json` or `table` and writes the files, if a folder is given.
void report(bool as_json, const nlohmann::json& json, const std::string& table, const std::string& folder,
            const OutputFiles& files);

/// A document as text; figures that are not defined are null.
std::string jsonText(const nlohmann::json& json);

}  // namespace semantic_mht_slam
