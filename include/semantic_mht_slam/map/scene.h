#pragma once

#include <vector>

#include <Eigen/Core>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/map/landmark.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// A landmark (or, for a single frame, a detection) as one keyframe sees it.
struct SceneObject {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< base frame of the keyframe
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< base frame of the keyframe
  ClassIndex class_index = 0;
  LandmarkId landmark = kNoLandmark;  ///< in the map; kNoLandmark for a detection
};

/// What one keyframe sees of the map (paper, section III-B).
struct Scene {
  std::vector<SceneObject> objects;
};

/// A landmark of a submap as the scene of a keyframe has it; `floor_m` is added to its deviation.
SceneObject sceneObject(const MixtureLandmark& landmark, const Pose& T_keyframe_submap, double floor_m);

}  // namespace semantic_mht_slam
