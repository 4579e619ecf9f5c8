#pragma once

#include <optional>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/stamped_pose.h"
#include "semantic_mht_slam/io/dataset.h"
#include "semantic_mht_slam/models/detection.h"

namespace semantic_mht_slam {

/// The detections of one detector frame, in the base frame.
struct DetectorFrame {
  Stamp stamp = 0;
  Detections detections;
};

/// A drive as it was recorded, from a data-set folder or from a bag.
struct Recording {
  std::vector<StampedPose> odometry;  ///< T_odom_base
  std::vector<DetectorFrame> detector_frames;
  std::optional<Pose> T_base_cam0;        ///< for output in the KITTI format; unknown: the base frame is used
  std::vector<StampedPose> ground_truth;  ///< T_map_base; empty if unknown
};

Recording toRecording(Dataset dataset);

}  // namespace semantic_mht_slam
