#pragma once

#include <cmath>
#include <vector>

#include "semantic_mht_slam/common/pose.h"
#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/map/scene.h"

namespace semantic_mht_slam {

/// Objects of random classes in a stretch of street of 60 m by 30 m.
inline Scene randomScene(int objects, int classes, Rng& rng) {
  Scene scene;
  for (int i = 0; i < objects; ++i) {
    SceneObject object;
    object.position_m = {rng.uniform(-30.0, 30.0), rng.uniform(-15.0, 15.0), rng.uniform(0.0, 3.0)};
    object.class_index = static_cast<ClassIndex>(rng.index(static_cast<std::uint64_t>(classes)));
    scene.objects.push_back(object);
  }
  return scene;
}

/// The same objects seen from elsewhere in the plane, each moved by noise.
inline Scene seenFrom(const Scene& scene, double yaw_rad, const Eigen::Vector3d& offset_m, double stddev_m, Rng& rng) {
  const Pose T_other_scene{expRotation({0.0, 0.0, yaw_rad}), offset_m};
  Scene seen = scene;
  for (SceneObject& object : seen.objects) {
    const Eigen::Vector3d noise_m(rng.normal(0.0, stddev_m), rng.normal(0.0, stddev_m), rng.normal(0.0, stddev_m));
    object.position_m = T_other_scene * object.position_m + noise_m;
  }
  return seen;
}

/// Names the objects of a scene as landmarks first_id, first_id + 1, ...
inline Scene withLandmarks(Scene scene, LandmarkId first_id) {
  for (SceneObject& object : scene.objects) object.landmark = first_id++;
  return scene;
}

}  // namespace semantic_mht_slam
