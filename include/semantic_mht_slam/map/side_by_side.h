#pragma once

#include <map>
#include <vector>

#include "semantic_mht_slam/map/submap.h"

namespace semantic_mht_slam {

/// Which landmarks cannot be one because a frame showed both side by side.
class SideBySide {
 public:
  /// Which landmarks the detections of some frames belong to, and which of them were near each other.
  void add(const std::vector<DetectionAssociation>& associations, const std::vector<NearLandmarks>& near);

  /// True if a frame showed both, further apart than parts of one object are.
  bool excludes(LandmarkId a, LandmarkId b) const;

  /// The same of any of two landmarks' names.
  bool excludes(const std::vector<LandmarkId>& names, const std::vector<LandmarkId>& others) const;

 private:
  std::map<LandmarkId, std::vector<std::size_t>> frames_of_;  ///< rising
  std::map<SameLandmark, int> near_frames_;                   ///< lesser id first
};

}  // namespace semantic_mht_slam
