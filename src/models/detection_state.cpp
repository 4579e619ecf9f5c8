#include "semantic_mht_slam/models/detection_state.h"

namespace semantic_mht_slam {

void transfer(StateArchive& archive, Detection& detection) {
  auto& [class_index, position_m, score, cov_m2, size_m, points, is_moving, row] = detection;
  archive(class_index, position_m, score, cov_m2, size_m, points, is_moving, row);
}

void transfer(StateArchive& archive, Frame& frame) {
  auto& [index, stamp, T_odom_base, detections] = frame;
  archive(index, stamp, T_odom_base, detections);
}

}  // namespace semantic_mht_slam
