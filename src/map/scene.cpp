#include "semantic_mht_slam/map/scene.h"

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {

SceneObject sceneObject(const MixtureLandmark& landmark, const Pose& T_keyframe_submap, double floor_m) {
  const Eigen::Matrix3d R = T_keyframe_submap.rotation.toRotationMatrix();
  return {T_keyframe_submap * landmark.position.mean_m,
          symmetric(R * landmark.position.cov_m2 * R.transpose()) + floor_m * floor_m * Eigen::Matrix3d::Identity(),
          landmark.mostLikelyClass(), landmark.id};
}

}  // namespace semantic_mht_slam
