#pragma once

#include <string>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/map/scene.h"
#include "semantic_mht_slam/models/class_table.h"

namespace semantic_mht_slam {

/// Pole, trunk (static) and vehicle (not).
inline ClassTable makeStreetClasses() {
  std::vector<ClassInfo> classes(3);
  const std::vector<std::string> names = {"pole", "trunk", "vehicle"};
  for (int c = 0; c < 3; ++c) {
    classes[c].id = c;
    classes[c].name = names[c];
    classes[c].is_static = c != 2;
  }
  return ClassTable(classes, "test");
}

/// Objects along a street of 80 m by 30 m; deviation of each coordinate of their centroids: `stddev_m`.
inline Scene makeStreet(int count, double stddev_m, Rng& rng) {
  Scene scene;
  for (int i = 0; i < count; ++i) {
    SceneObject object;
    object.position_m = {rng.uniform(-40.0, 40.0), rng.uniform(-15.0, 15.0), rng.uniform(-0.3, 0.3)};
    object.cov_m2 = Eigen::Matrix3d::Identity() * (stddev_m * stddev_m);
    object.class_index = static_cast<ClassIndex>(rng.index(3));
    scene.objects.push_back(object);
  }
  return scene;
}

/// The scene as it is seen from another keyframe, `T_scene_keyframe` being its pose in the frame of the scene, with
/// noise of the objects' covariance.
inline Scene seenFrom(const Scene& scene, const Pose& T_scene_keyframe, Rng& rng) {
  Scene seen = scene;
  for (SceneObject& object : seen.objects) {
    const double stddev_m = std::sqrt(object.cov_m2(0, 0));
    object.position_m = T_scene_keyframe.inverse() * object.position_m;
    for (int axis = 0; axis < 3; ++axis) object.position_m(axis) += rng.normal(0.0, stddev_m);
  }
  return seen;
}

inline Pose planarPose(double x_m, double y_m, double yaw_rad) {
  return {expRotation({0.0, 0.0, yaw_rad}), {x_m, y_m, 0.0}};
}

}  // namespace semantic_mht_slam
