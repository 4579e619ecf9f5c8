#include "evaluate_alignment_scenes.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Geometry>

#include "semantic_mht_slam/evaluation/rigid_alignment.h"

namespace semantic_mht_slam {
namespace {

constexpr double kRevisit_m = 3.0;
constexpr std::size_t kRevisitFrames = 200;
constexpr double kLandmarkRadius_m = 0.8;
constexpr int kMinSightings = 4;
constexpr double kMaxRegistration_m = 2.0;

/// A landmark in the making.
struct Cluster {
  ClassIndex class_index = 0;
  Eigen::Vector3d weighted_sum_m = Eigen::Vector3d::Zero();
  double weight = 0.0;
  int sightings = 0;
  std::map<int, int> true_landmarks;  // how often each

  Eigen::Vector3d position_m() const { return weighted_sum_m / weight; }
  int trueLandmark() const {
    const auto most = std::max_element(true_landmarks.begin(), true_landmarks.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == true_landmarks.end() ? -1 : most->first;
  }
};

/// Detector noise turned into the direction of the ray.
Eigen::Matrix3d detectionCov(const Detection& detection, const ClassInfo& info) {
  if (detection.cov_m2) return *detection.cov_m2;
  const Eigen::Vector3d ray = detection.position_m.normalized();
  const double lateral_m2 = info.lateral_stddev_m * info.lateral_stddev_m;
  const double range_m2 = info.range_stddev_m * info.range_stddev_m;
  return lateral_m2 * Eigen::Matrix3d::Identity() + (range_m2 - lateral_m2) * ray * ray.transpose();
}

double clusterRadius(const ClassInfo& info) {
  return std::max(kLandmarkRadius_m, 2.5 * info.range_stddev_m);
}

Cluster& nearestCluster(std::vector<Cluster>& clusters, ClassIndex class_index, const Eigen::Vector3d& position_m,
                        double radius_m) {
  Cluster* nearest = nullptr;
  double nearest_m = radius_m;
  for (Cluster& cluster : clusters) {
    if (cluster.class_index != class_index) continue;
    const double distance_m = (cluster.position_m() - position_m).head<2>().norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = &cluster;
  }
  if (nearest != nullptr) return *nearest;
  clusters.push_back({});
  clusters.back().class_index = class_index;
  return clusters.back();
}

std::vector<Cluster> buildMap(const Dataset& dataset, const ClassTable& classes,
                              const std::optional<TrueLandmarks>& truth, std::size_t begin, std::size_t end) {
  std::vector<Cluster> clusters;
  for (std::size_t f = begin; f < end; ++f) {
    const Detections& detections = dataset.detections[f];
    for (std::size_t i = 0; i < detections.size(); ++i) {
      const Eigen::Vector3d position_m = (*dataset.T_map_base)[f] * detections[i].position_m;
      const double weight = 1.0 / (1.0 + detections[i].position_m.squaredNorm() / 100.0);  // near ones are less biased
      const ClassIndex c = detections[i].class_index;
      Cluster& cluster = nearestCluster(clusters, c, position_m, clusterRadius(classes[c]));
      cluster.weighted_sum_m += weight * position_m;
      cluster.weight += weight;
      ++cluster.sightings;
      if (truth) ++cluster.true_landmarks[(*truth)[f][i]];
    }
  }
  const auto is_rare = [](const Cluster& cluster) { return cluster.sightings < kMinSightings; };
  clusters.erase(std::remove_if(clusters.begin(), clusters.end(), is_rare), clusters.end());
  return clusters;
}

RegistrationPoint landmark(const Cluster& cluster, const ClassInfo& info) {
  const double variance_m2 = info.range_stddev_m * info.range_stddev_m / kMinSightings;
  return {cluster.position_m(), variance_m2 * Eigen::Matrix3d::Identity(), cluster.class_index};
}

/// The nearest earlier frame, if this one comes back to it.
std::optional<std::size_t> revisited(const std::vector<Pose>& poses, std::size_t frame) {
  std::optional<std::size_t> nearest;
  double nearest_m = kRevisit_m;
  for (std::size_t f = 0; f + kRevisitFrames < frame; ++f) {
    const double distance_m = (poses[f].translation_m - poses[frame].translation_m).norm();
    if (distance_m >= nearest_m) continue;
    nearest_m = distance_m;
    nearest = f;
  }
  return nearest;
}

/// Frames driven within `half_length_m` before and after `center`, not after `last`.
std::pair<std::size_t, std::size_t> frameRange(const std::vector<Pose>& poses, std::size_t center, std::size_t last,
                                               double half_length_m) {
  const auto stepLength = [&](std::size_t f) { return (poses[f + 1].translation_m - poses[f].translation_m).norm(); };
  std::size_t begin = center;
  for (double length_m = 0.0; begin > 0 && length_m < half_length_m; --begin) length_m += stepLength(begin - 1);
  std::size_t end = center;
  for (double length_m = 0.0; end < last && length_m < half_length_m; ++end) length_m += stepLength(end);
  return {begin, end};
}

/// For each detection the landmark that is its nearest of the class and has it as its nearest, or -1.
std::vector<int> mutualNearest(const AlignmentScene& scene, const Pose& T_map_base,
                               const std::vector<double>& radii_m) {
  const auto nearest = [&](const std::vector<Eigen::Vector3d>& targets_m, const std::vector<RegistrationPoint>& points,
                           const Eigen::Vector3d& position_m, ClassIndex class_index) {
    int result = -1;
    double nearest_m = radii_m[class_index];
    for (std::size_t k = 0; k < points.size(); ++k) {
      if (points[k].class_index != class_index) continue;
      const double distance_m = (targets_m[k] - position_m).head<2>().norm();
      if (distance_m >= nearest_m) continue;
      nearest_m = distance_m;
      result = static_cast<int>(k);
    }
    return result;
  };
  std::vector<Eigen::Vector3d> detections_m, landmarks_m;
  for (const RegistrationPoint& point : scene.detections) detections_m.push_back(T_map_base * point.position_m);
  for (const RegistrationPoint& point : scene.landmarks) landmarks_m.push_back(point.position_m);
  std::vector<int> result;
  for (std::size_t i = 0; i < detections_m.size(); ++i) {
    const ClassIndex c = scene.detections[i].class_index;
    const int l = nearest(landmarks_m, scene.landmarks, detections_m[i], c);
    const bool is_mutual = l >= 0 && nearest(detections_m, scene.detections, landmarks_m[l], c) == static_cast<int>(i);
    result.push_back(is_mutual ? l : -1);
  }
  return result;
}

/// Moves `T_map_base` until mutual nearest neighbours lie on each other; static classes alone if there are enough.
Pose registered(const AlignmentScene& scene, const ClassTable& classes) {
  Pose T_map_base = scene.T_map_base;
  for (const double radius_m : {2.0, 2.0, 1.5, 1.5, 1.0, 1.0, 1.0, 0.7, 0.7, 0.7}) {
    const std::vector<int> pairs = mutualNearest(scene, T_map_base, std::vector<double>(classes.size(), radius_m));
    std::vector<Eigen::Vector3d> source_m, target_m, source_static_m, target_static_m;
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      if (pairs[i] < 0) continue;
      source_m.push_back(T_map_base * scene.detections[i].position_m);
      target_m.push_back(scene.landmarks[pairs[i]].position_m);
      if (!classes[scene.detections[i].class_index].is_static) continue;
      source_static_m.push_back(source_m.back());
      target_static_m.push_back(target_m.back());
    }
    if (source_m.size() < 3) return T_map_base;
    const bool statics_suffice = source_static_m.size() >= 5;
    T_map_base =
        planarAlignment(statics_suffice ? source_static_m : source_m, statics_suffice ? target_static_m : target_m) *
        T_map_base;
  }
  return T_map_base;
}

/// Counterparts without true landmark numbers; false if the registration found none.
bool matchByRegistration(AlignmentScene& scene, const ClassTable& classes) {
  const Pose T_map_base = registered(scene, classes);
  if ((T_map_base.translation_m - scene.T_map_base.translation_m).norm() > kMaxRegistration_m) return false;
  scene.T_map_base = T_map_base;
  std::vector<double> radii_m;
  for (const ClassInfo& info : classes.all()) radii_m.push_back(info.is_static ? 0.5 : 1.5);
  int counterparts = 0;
  for (const int l : mutualNearest(scene, T_map_base, radii_m)) {
    scene.right_matches.emplace_back(l >= 0 ? 1 : 0, l);
    counterparts += l >= 0;
  }
  return counterparts >= 3;
}

void matchByTruth(AlignmentScene& scene, const std::vector<Cluster>& clusters, const std::vector<int>& true_landmarks) {
  for (const int true_landmark : true_landmarks) {
    scene.right_matches.emplace_back();
    for (std::size_t l = 0; l < clusters.size() && true_landmark >= 0; ++l) {
      if (clusters[l].trueLandmark() == true_landmark) scene.right_matches.back().push_back(static_cast<int>(l));
    }
  }
}

}  // namespace

std::vector<AlignmentScene> alignmentScenes(const Dataset& dataset, const ClassTable& classes,
                                            const std::optional<TrueLandmarks>& truth, std::size_t step,
                                            double half_length_m) {
  const std::vector<Pose>& poses = *dataset.T_map_base;
  std::vector<AlignmentScene> scenes;
  for (std::size_t f = 0; f < dataset.frames(); f += step) {
    const std::optional<std::size_t> earlier = revisited(poses, f);
    if (!earlier) continue;
    const auto [begin, end] = frameRange(poses, *earlier, f - kRevisitFrames, half_length_m);
    const std::vector<Cluster> clusters = buildMap(dataset, classes, truth, begin, end);
    AlignmentScene scene;
    scene.frame = f;
    scene.T_map_base = poses[f];
    for (const Detection& detection : dataset.detections[f]) {
      const ClassInfo& info = classes[detection.class_index];
      scene.detections.push_back({detection.position_m, detectionCov(detection, info), detection.class_index});
    }
    for (const Cluster& cluster : clusters) {
      scene.landmarks.push_back(landmark(cluster, classes[cluster.class_index]));
    }
    if (truth) {
      matchByTruth(scene, clusters, (*truth)[f]);
    } else if (!matchByRegistration(scene, classes)) {
      continue;
    }
    scenes.push_back(std::move(scene));
  }
  return scenes;
}

}  // namespace semantic_mht_slam
