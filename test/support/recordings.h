#pragma once

#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/recording.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// A table of two classes, ids 7 and 9.
inline ClassTable makeTwoClasses() {
  std::vector<ClassInfo> classes(2);
  classes[0].id = 7;
  classes[0].name = "pole";
  classes[0].color = "#ff0000";
  classes[1].id = 9;
  classes[1].name = "vehicle";
  classes[1].color = "#0000ff";
  classes[1].is_static = false;
  return ClassTable(classes, "test");
}

/// A drive on a circle: one odometry sample and one detector frame every 0.1 s, each with `index % 4` objects, so that
/// some frames are empty. The ground truth lies 1 m beside the odometry.
inline Recording makeCircleRecording(std::size_t frames) {
  Recording recording;
  recording.T_base_cam0 = Pose{Eigen::Quaterniond(0.5, -0.5, 0.5, -0.5), {0.27, 0.01, -0.08}};
  Rng rng(3);
  for (std::size_t i = 0; i < frames; ++i) {
    const Stamp stamp = static_cast<Stamp>(i) * 100000000;
    const double angle = 0.02 * static_cast<double>(i);
    const Pose T_odom_base{expRotation({0.0, 0.0, angle}),
                           {40.0 * std::sin(angle), 40.0 * (1.0 - std::cos(angle)), 0.1}};
    recording.odometry.push_back({stamp, T_odom_base});
    recording.ground_truth.push_back({stamp, Pose{{1.0, 0.0, 0.0, 0.0}, {0.0, 1.0, 0.0}} * T_odom_base});
    DetectorFrame frame{stamp, {}};
    for (std::size_t row = 0; row < i % 4; ++row) {
      Detection detection;
      detection.class_index = static_cast<ClassIndex>(row % 2);
      detection.position_m = {rng.uniform(2.0, 30.0), rng.uniform(-15.0, 15.0), rng.uniform(-1.0, 1.0)};
      if (row == 1) detection.score = 0.25;
      if (row == 1) detection.is_moving = true;
      if (row == 2) detection.points = 33;
      if (row == 2) detection.cov_m2 = Eigen::Matrix3d(Eigen::Vector3d(0.04, 0.01, 0.09).asDiagonal());
      detection.row = static_cast<int>(row);
      frame.detections.push_back(detection);
    }
    recording.detector_frames.push_back(frame);
  }
  return recording;
}

/// The KITTI folder of the data that SEMANTIC_MHT_SLAM_DATA names; empty where there is none.
inline std::optional<std::string> kittiFolder(const std::string& sequence) {
  const char* folder = std::getenv("SEMANTIC_MHT_SLAM_DATA");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return std::string(folder) + "/kitti/" + sequence;
}

}  // namespace semantic_mht_slam
