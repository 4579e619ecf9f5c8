#include "semantic_mht_slam/place/scene_accumulation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <Eigen/Geometry>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMergeSigmas = 2.5;
constexpr std::size_t kLongWindow = 5;  // frames

Eigen::Matrix3d classCov(const Eigen::Vector3d& position_m, const ClassInfo& info) {
  const Eigen::Vector3d ray = position_m.norm() > 1e-6 ? position_m.normalized() : Eigen::Vector3d::UnitX();
  const double along_m2 = info.range_stddev_m * info.range_stddev_m;
  const double across_m2 = info.lateral_stddev_m * info.lateral_stddev_m;
  return across_m2 * Eigen::Matrix3d::Identity() + (along_m2 - across_m2) * ray * ray.transpose();
}

/// An object in the making: the running mean of its detections.
struct Cluster {
  SceneObject object;
  int sightings = 0;

  void add(const SceneObject& seen) {
    ++sightings;
    object.position_m += (seen.position_m - object.position_m) / sightings;
    if (seen.cov_m2.trace() < object.cov_m2.trace()) object.cov_m2 = seen.cov_m2;
  }
};

Cluster* nearestCluster(std::vector<Cluster>& clusters, const SceneObject& seen, double min_merge_radius_m) {
  Cluster* nearest = nullptr;
  double best_m = std::max(min_merge_radius_m, kMergeSigmas * std::sqrt(seen.cov_m2.trace() / 3.0));
  for (Cluster& cluster : clusters) {
    if (cluster.object.class_index != seen.class_index) continue;
    const double distance_m = (cluster.object.position_m - seen.position_m).head<2>().norm();
    if (distance_m >= best_m) continue;
    best_m = distance_m;
    nearest = &cluster;
  }
  return nearest;
}

}  // namespace

Scene sceneOfFrame(const Detections& detections, const ClassTable& classes) {
  Scene scene;
  for (const Detection& detection : detections) {
    if (detection.class_index < 0 || detection.class_index >= classes.size()) {
      throw std::invalid_argument("a detection has an unknown class");
    }
    SceneObject object;
    object.position_m = detection.position_m;
    object.cov_m2 = detection.cov_m2.value_or(classCov(detection.position_m, classes[detection.class_index]));
    object.class_index = detection.class_index;
    scene.objects.push_back(object);
  }
  return scene;
}

Scene accumulateScene(const std::vector<Detections>& frames, const std::vector<Pose>& T_base_frame,
                      const ClassTable& classes, double min_merge_radius_m) {
  if (frames.size() != T_base_frame.size()) throw std::invalid_argument("accumulateScene: a pose a frame is needed");
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Eigen::Matrix3d rotation = T_base_frame[i].rotation.toRotationMatrix();
    for (SceneObject seen : sceneOfFrame(frames[i], classes).objects) {
      seen.position_m = T_base_frame[i] * seen.position_m;
      seen.cov_m2 = rotation * seen.cov_m2 * rotation.transpose();
      seen.cov_m2 = symmetric(seen.cov_m2);
      Cluster* cluster = nearestCluster(clusters, seen, min_merge_radius_m);
      if (cluster == nullptr) cluster = &clusters.emplace_back(Cluster{seen, 0});
      cluster->add(seen);
    }
  }
  const int least_sightings = frames.size() >= kLongWindow ? 2 : 1;
  Scene scene;
  for (const Cluster& cluster : clusters) {
    if (cluster.sightings >= least_sightings) scene.objects.push_back(cluster.object);
  }
  return scene;
}

}  // namespace semantic_mht_slam
