#pragma once

#include <string>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/models/camera.h"

namespace semantic_mht_slam {

/// The `Tr:` line of a KITTI calib.txt: T_cam0_velodyne. Throws InputError if the file or the line is missing or the
/// line has not 12 finite numbers.
Pose readCalibration(const std::string& path);

/// The left colour camera of a KITTI calibration and where it sits on the Velodyne: the lines `P2:`, `R0_rect:`
/// (identity where there is none, as in the odometry data set) and `Tr:` or `Tr_velo_to_cam:`. Throws InputError as
/// above.
Camera readCamera(const std::string& path);

/// A calib.txt that holds the `Tr:` line alone.
std::string formatCalibration(const Pose& T_cam0_velodyne);

}  // namespace semantic_mht_slam
