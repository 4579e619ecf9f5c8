#include "semantic_mht_slam/mapping/landmark_sizes.h"

#include <map>

namespace semantic_mht_slam {

void noteSizes(const std::vector<Frame>& frames, Submap& submap) {
  std::map<std::pair<std::size_t, int>, const Eigen::Vector3d*> said;  // by frame and row
  for (const Frame& frame : frames) {
    for (const Detection& detection : frame.detections) {
      if (detection.size_m) said[{frame.index, detection.row}] = &*detection.size_m;
    }
  }
  if (said.empty()) return;
  std::map<LandmarkId, LandmarkSize> sizes;
  for (const DetectionAssociation& association : submap.associations) {
    const auto size_m = said.find({association.frame, association.row});
    if (size_m != said.end()) sizes[association.landmark].add({*size_m->second, 1});
  }
  for (MixtureLandmark& landmark : submap.landmarks) {
    const auto size = sizes.find(landmark.id);
    if (size != sizes.end()) landmark.size = size->second;
  }
}

}  // namespace semantic_mht_slam
