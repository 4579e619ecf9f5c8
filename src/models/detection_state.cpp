#include "semantic_mht_slam/models/detection_state.h"

#include "semantic_mht_slam/models/usable_detection.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, Detection& detection) {
  auto& [class_index, position_m, score, cov_m2, size_m, points, is_moving, row] = detection;
  archive(class_index, position_m, score, cov_m2, size_m, points, is_moving, row);
  archive.requireClass(class_index);
  archive.require(isUsable(detection) && row >= 0, "a detection that would have been dropped");
}

void transfer(StateArchive& archive, Frame& frame) {
  auto& [index, stamp, T_odom_base, detections] = frame;
  archive(index, stamp, T_odom_base, detections);
  archive.requireStamp(stamp);
}

}  // namespace semantic_mht_slam
