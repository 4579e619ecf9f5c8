#pragma once

#include <cstddef>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/stamp.h"
#include "semantic_mht_slam/map/ids.h"
#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/odometry_model.h"

namespace semantic_mht_slam {

/// A landmark as the detections of one keyframe show it: what the pose graph learns from.
struct Sighting {
  LandmarkId landmark = kNoLandmark;  ///< as the submap calls it
  ClassIndex class_index = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< base frame of the keyframe
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< base frame of the keyframe
  int detections = 0;
};

/// A stretch of a submap that is short enough for its odometry to be trusted, named by its first frame, with what was
/// seen in it.
struct Keyframe {
  std::size_t frame = 0;  ///< index of the detector frame
  SubmapId submap;        ///< that the frame belongs to
  double driven_m = 0.0;  ///< since the beginning of the drive
  Scene scene = {};       ///< base frame; positions by all detections of the submap and before
  Stamp stamp = 0;
  Pose T_odom_base = Pose::identity();
  double turned_rad = 0.0;  ///< of the heading, whichever way, since the beginning of the drive
};

/// What the vehicle moved from the beginning of the drive to a keyframe.
inline Motion motionTo(const Keyframe& keyframe) {
  return {keyframe.driven_m, keyframe.turned_rad};
}

}  // namespace semantic_mht_slam
