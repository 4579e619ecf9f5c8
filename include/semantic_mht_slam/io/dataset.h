#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/models/detection.h"
#include "semantic_mht_slam/models/gnss_fix.h"

namespace semantic_mht_slam {

/// A drive in memory: one entry a frame in each list. The base frame is the Velodyne; the odom and the map frame are
/// the base frame of the first row of their file, if that row is the identity, as KITTI has it.
struct Dataset {
  std::vector<Stamp> stamps;
  Pose T_cam0_base;
  std::vector<Pose> T_odom_base;
  std::vector<Detections> detections;
  std::optional<std::vector<Pose>> T_map_base;  ///< ground truth
  std::string notice;                           ///< of what was ignored in the objects file; empty: nothing
  std::vector<GnssFix> fixes = {};              ///< by rising stamps
  std::string fixes_notice = {};                ///< as `notice`, of the file of fixes

  std::size_t frames() const { return stamps.size(); }
};

/// Which files of a data-set folder to read; relative paths are looked up in the folder first.
struct DatasetFiles {
  std::string folder;
  std::string objects = "objects.csv";  ///< empty: none are read, each frame has no detections
  std::string odometry = "odometry/vo_orb.txt";
  std::string fixes = {};  ///< empty: none are read
};

/// Reads times.txt, calib.txt, odometry and objects, fixes if they are asked for, and poses.txt if there is one.
/// Throws InputError naming the file if one is missing, malformed, or has another number of rows than times.txt.
Dataset readDataset(const DatasetFiles& files, const ClassTable& classes);

/// Writes times.txt, calib.txt, odometry/odometry.txt, objects.csv and, if known, poses.txt.
/// The folder must be prepared. Throws InputError.
void writeDataset(const Dataset& dataset, const ClassTable& classes, const std::string& folder);

/// KITTI files hold camera poses: T_world_cam0, world being camera 0 of the first frame. This is the base frame's
/// trajectory T_world_base, world being the base frame of the first frame; `toCamera` is its inverse.
Pose toBase(const Pose& T_world_cam0, const Pose& T_cam0_base);
Pose toCamera(const Pose& T_world_base, const Pose& T_cam0_base);

}  // namespace semantic_mht_slam
