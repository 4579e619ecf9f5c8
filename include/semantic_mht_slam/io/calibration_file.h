#pragma once

#include <string>

#include "semantic_mht_slam/common/pose.h"

namespace semantic_mht_slam {

/// The `Tr:` line of a KITTI calib.txt: T_cam0_velodyne. Throws InputError if the file or the line is missing or the
/// line has not 12 finite numbers.
Pose readCalibration(const std::string& path);

/// A calib.txt that holds the `Tr:` line alone.
std::string formatCalibration(const Pose& T_cam0_velodyne);

}  // namespace semantic_mht_slam
