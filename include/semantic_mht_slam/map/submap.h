#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/map/ids.h"
#include "semantic_mht_slam/map/landmark.h"

namespace semantic_mht_slam {

/// Which landmark a detection belongs to.
struct DetectionAssociation {
  std::size_t frame = 0;
  int row = 0;                        ///< of the detection in its frame
  LandmarkId landmark = kNoLandmark;  ///< kNoLandmark: a false positive
  /// That it is of that landmark if that is there, or that it is of nothing; in thousandths, as files keep it.
  double probability = 1.0;
};

/// Two names of one landmark.
using SameLandmark = std::pair<LandmarkId, LandmarkId>;

/// Two landmarks that one frame showed, or several, so near each other that they may be parts of one object.
struct NearLandmarks {
  LandmarkId a = kNoLandmark;  ///< less than b
  LandmarkId b = kNoLandmark;
  int frames = 0;
};

/// Where a submap lies in the map of earlier passes, as the hypotheses over joint alignments found it.
struct MapAlignment {
  Pose T_earlier_submap;  ///< into the predicted frame that the earlier map was given in
  /// Of T_earlier_submap: order translation (m), rotation (rad), in the frame of the submap, a small step on the right.
  Eigen::Matrix<double, 6, 6> cov = Eigen::Matrix<double, 6, 6>::Zero();
  double weight = 0.0;  ///< summed weight of the hypotheses that agree
  int matches = 0;      ///< landmarks that submap and earlier map have in common
  bool is_accepted = false;
  std::vector<SameLandmark> pairs;  ///< of the submap, of the earlier map; empty if it is not accepted
};

/// A finished stretch of the drive with what was mapped in it. Immutable.
struct Submap {
  SubmapId id;
  Stamp begin = 0;
  Stamp end = 0;
  Pose T_odom_submap;                              ///< odometry at its first frame
  std::vector<MixtureLandmark> landmarks;          ///< submap frame, by rising id: seen in this submap
  std::vector<DetectionAssociation> associations;  ///< of every detection in it, by frame and row
  std::vector<SameLandmark> duplicates;            ///< second name, first name; in the order in which they were found
  std::vector<NearLandmarks> near;                 ///< by rising ids
};

}  // namespace semantic_mht_slam
