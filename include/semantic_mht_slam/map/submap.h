#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// Which landmark a detection belongs to.
struct DetectionAssociation {
  std::size_t frame = 0;
  int row = 0;                        ///< of the detection in its frame
  LandmarkId landmark = kNoLandmark;  ///< kNoLandmark: a false positive
};

/// A landmark that turned out to be another one; its id stays resolvable through this.
struct MergedLandmark {
  LandmarkId merged = kNoLandmark;
  LandmarkId survivor = kNoLandmark;
};

/// Where a submap lies in the map of earlier passes, as the hypotheses over joint alignments found it.
struct MapAlignment {
  Pose T_earlier_submap;  ///< into the predicted frame that the earlier map was given in
  /// Covariance of x, y, z of the submap's origin (axes of the predicted frame, m) and of its heading (rad).
  Eigen::Matrix4d cov = Eigen::Matrix4d::Zero();
  double weight = 0.0;  ///< summed weight of the hypotheses that agree
  int matches = 0;      ///< landmarks that submap and earlier map have in common
  bool is_accepted = false;
};

/// A finished stretch of the drive with what was mapped in it. Immutable.
struct Submap {
  int index = 0;
  Stamp begin = 0;
  Stamp end = 0;
  Pose T_odom_submap;                              ///< odometry at its first frame
  std::vector<MixtureLandmark> landmarks;          ///< submap frame, by rising id: seen in this submap
  std::vector<DetectionAssociation> associations;  ///< of every detection in it, by frame and row
  std::vector<MergedLandmark> merged;              ///< in the order in which they were found
  std::optional<MapAlignment> alignment;           ///< against the earlier map, if there was one and it fits
};

}  // namespace semantic_mht_slam
