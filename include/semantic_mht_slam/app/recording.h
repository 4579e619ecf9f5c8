#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/app/refused_input.h"
#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

/// The detections of one detector frame, in the base frame.
struct DetectorFrame {
  Stamp stamp = 0;
  Detections detections;
  std::optional<std::size_t> odometry_before = {};  ///< samples that came before it; unknown: those stamped before it
};

/// A drive as it was recorded, from a data-set folder or from a bag: what may go to the estimator, in the order in
/// which it came.
struct Recording {
  std::vector<StampedPose> odometry;  ///< T_odom_base
  std::vector<DetectorFrame> detector_frames;
  std::vector<GnssFix> fixes = {};        ///< by rising stamps
  std::optional<Pose> T_base_cam0;        ///< for output in the KITTI format; unknown: the base frame is used
  std::vector<StampedPose> ground_truth;  ///< T_map_base; empty if unknown
  RefusedInput refused;                   ///< what was left out when it was read
  InputNames names;
};

Recording toRecording(Dataset dataset);

}  // namespace semantic_mht_slam
