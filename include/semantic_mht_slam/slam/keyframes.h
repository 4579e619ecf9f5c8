#pragma once

#include <functional>
#include <vector>

#include "semantic_mht_slam/common/config.h"
#include "semantic_mht_slam/map/submap.h"
#include "semantic_mht_slam/models/odometry_noise.h"
#include "semantic_mht_slam/place/scene.h"
#include "semantic_mht_slam/slam/frame.h"

namespace semantic_mht_slam {

/// How finished submaps are cut into keyframes, the nodes of the pose graph.
struct KeyframeConfig {
  double spacing_m = 5.0;
  double sighting_floor_m = 0.1;
  double vertical_floor_m = 1.0;
};

void describe(KeyframeConfig& config, Fields& fields);

/// A landmark as the detections of one keyframe show it.
struct KeyframeSighting {
  LandmarkId landmark = kNoLandmark;
  ClassIndex class_index = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  ///< base frame of the keyframe
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();  ///< base frame of the keyframe
  int detections = 0;
};

/// A stretch of a submap that is short enough for its odometry to be trusted, named by its first frame.
struct MapKeyframe {
  std::size_t frame = 0;
  Stamp stamp = 0;
  double driven_m = 0.0;  ///< since the beginning of the drive
  Pose T_odom_base;
  std::vector<KeyframeSighting> sightings;  ///< by rising landmark id
  Scene scene;  ///< the same landmarks, positions by all detections of the submap and before
};

/// A landmark of a submap as the scene of a keyframe has it; `floor_m` is added to its deviation.
SceneObject sceneObject(const MixtureLandmark& landmark, const Pose& T_keyframe_submap, double floor_m);

/// What a sighting's covariance is made of.
struct SightingNoise {
  OdometryNoise odometry;                                     ///< from the keyframe to the detection
  std::function<Eigen::Matrix3d(const Detection&)> detector;  ///< of a detection's centroid, base frame, m^2
};

/// Cuts a submap into keyframes. `frames` are those of the submap in their order; `driven_m` was driven before the
/// first of them. Every landmark of the submap with at least `keep_prob` of existence gets one sighting a keyframe that
/// sees it: the information-weighted mean of its detections, carried to the keyframe by odometry, with a floor for
/// errors that they share.
std::vector<MapKeyframe> cutIntoKeyframes(const Submap& submap, const std::vector<Frame>& frames, double driven_m,
                                          double keep_prob, const SightingNoise& noise, const KeyframeConfig& config);

}  // namespace semantic_mht_slam
