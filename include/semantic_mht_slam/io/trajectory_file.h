#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/common/stamped_pose.h"

namespace semantic_mht_slam {

/// KITTI format: a row a frame, 12 numbers, the row-major 3x4 matrix T_world_cam0 in metres.
/// Throws InputError naming file and line for a wrong column count, a number that is not finite, or a matrix that is no
/// rotation (R^T R off by more than 0.01).
std::vector<Pose> readKittiTrajectory(const std::string& path);

/// Writes the KITTI format with every digit that the numbers have.
std::string formatKittiTrajectory(const std::vector<Pose>& T_world_cam0);

/// TUM format: "seconds tx ty tz qx qy qz qw", rising stamps.
/// Throws InputError naming file and line as above, and for stamps that do not rise.
std::vector<StampedPose> readTumTrajectory(const std::string& path);

/// Writes the TUM format: nine decimals of the stamp, every digit of the rest.
std::string formatTumTrajectory(const std::vector<StampedPose>& trajectory);

/// KITTI times.txt: a stamp a row, seconds, rising.
std::vector<Stamp> readTimes(const std::string& path);
std::string formatTimes(const std::vector<Stamp>& stamps);

}  // namespace semantic_mht_slam
