#include "semantic_mht_slam/app/recording.h"

#include <utility>

namespace semantic_mht_slam {

Recording toRecording(Dataset dataset) {
  Recording recording;
  recording.T_base_cam0 = dataset.T_cam0_base.inverse();
  recording.fixes = std::move(dataset.fixes);
  for (std::size_t i = 0; i < dataset.frames(); ++i) {
    const Stamp stamp = dataset.stamps[i];
    recording.odometry.push_back({stamp, dataset.T_odom_base[i]});
    recording.detector_frames.push_back({stamp, std::move(dataset.detections[i])});
    if (dataset.T_map_base) recording.ground_truth.push_back({stamp, (*dataset.T_map_base)[i]});
  }
  return recording;
}

}  // namespace semantic_mht_slam
