#include "semantic_mht_slam/place/scene_accumulation.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <tuple>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr double kGateMahalanobisSq = 13.8;  // 99.9 % in two dimensions
constexpr std::size_t kLongWindow = 5;       // frames
constexpr double kMistaken = 1.0 / 3.0;      // of the sightings of an object that the detector may call something else

Eigen::Matrix3d classCov(const Eigen::Vector3d& position_m, const ClassInfo& info) {
  const Eigen::Vector3d ray = position_m.norm() > 1e-6 ? position_m.normalized() : Eigen::Vector3d::UnitX();
  const double along_m2 = info.range_stddev_m * info.range_stddev_m;
  const double across_m2 = info.lateral_stddev_m * info.lateral_stddev_m;
  return across_m2 * Eigen::Matrix3d::Identity() + (along_m2 - across_m2) * ray * ray.transpose();
}

/// A detection in the base frame, with what the odometry may be off by between its frame and there.
struct SceneSighting {
  SceneObject object;
  Eigen::Matrix3d drift_m2 = Eigen::Matrix3d::Zero();
};

SceneSighting sightingOf(const SceneObject& seen, const SeenFrame& frame) {
  const Eigen::Matrix3d R = frame.T_base_frame.rotation.toRotationMatrix();
  SceneSighting sighting{seen, Eigen::Matrix3d::Zero()};
  sighting.object.position_m = frame.T_base_frame * seen.position_m;
  sighting.object.cov_m2 = symmetric(R * seen.cov_m2 * R.transpose());
  const double planar_m2 = std::max(frame.drift.along_m2, frame.drift.across_m2);
  const Eigen::Vector3d reach_m = sighting.object.position_m - 0.5 * frame.T_base_frame.translation_m;
  const Eigen::Vector3d swing_m(-reach_m.y(), reach_m.x(), 0.0);
  sighting.drift_m2.diagonal() << planar_m2, planar_m2,
      frame.drift.up_m2 + frame.drift.tilt_rad2 * reach_m.head<2>().squaredNorm();
  sighting.drift_m2 += frame.drift.heading_rad2 * swing_m * swing_m.transpose();
  return sighting;
}

/// An object in the making: the mean of its sightings, weighted by what each knows.
struct Cluster {
  ClassIndex class_index = 0;
  Eigen::Matrix3d weight = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  Eigen::Matrix3d by_detector = Eigen::Matrix3d::Zero();  ///< information, the odometry's error aside
  Eigen::Matrix3d drift_m2 = Eigen::Matrix3d::Constant(std::numeric_limits<double>::infinity());
  std::vector<std::size_t> frames;  ///< that saw it, rising
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d cov_m2 = Eigen::Matrix3d::Identity();

  void add(const SceneSighting& seen, std::size_t frame) {
    const Eigen::Matrix3d information = (seen.object.cov_m2 + seen.drift_m2).inverse();
    weight += information;
    weighted += information * seen.object.position_m;
    by_detector += seen.object.cov_m2.inverse();
    if (seen.drift_m2.trace() < drift_m2.trace()) drift_m2 = seen.drift_m2;
    frames.push_back(frame);
    settle();
  }

  void add(const Cluster& other) {
    weight += other.weight;
    weighted += other.weighted;
    by_detector += other.by_detector;
    if (other.drift_m2.trace() < drift_m2.trace()) drift_m2 = other.drift_m2;
    std::vector<std::size_t> all;
    std::merge(frames.begin(), frames.end(), other.frames.begin(), other.frames.end(), std::back_inserter(all));
    frames = std::move(all);
    settle();
  }

 private:
  /// What the detector errs by averages out; the odometry's error is the same for sightings that follow each other.
  void settle() {
    position_m = weight.inverse() * weighted;
    cov_m2 = symmetric(by_detector.inverse()) + drift_m2;
  }
};

/// Squared Mahalanobis distance seen from above; infinite beyond the gate. What stands within `least_m` is within it.
double distanceOf(const Eigen::Vector3d& apart_m, const Eigen::Matrix3d& cov_m2, double least_m) {
  const Eigen::Vector2d planar_m = apart_m.head<2>();
  const Eigen::Matrix2d planar_m2 = cov_m2.topLeftCorner<2, 2>();
  const double distance_sq = planar_m.dot(planar_m2.inverse() * planar_m);
  const bool is_near = distance_sq < kGateMahalanobisSq || planar_m.squaredNorm() < least_m * least_m;
  return is_near ? distance_sq : std::numeric_limits<double>::infinity();
}

bool areSeenTogether(const Cluster& a, const Cluster& b) {
  auto in_a = a.frames.begin();
  auto in_b = b.frames.begin();
  while (in_a != a.frames.end() && in_b != b.frames.end()) {
    if (*in_a == *in_b) return true;
    *in_a < *in_b ? ++in_a : ++in_b;
  }
  return false;
}

class Accumulation {
 public:
  explicit Accumulation(double min_merge_radius_m) : min_merge_radius_m_(min_merge_radius_m) {}

  /// What one frame shows are so many objects: each detection goes to another one, the nearest first.
  void add(const std::vector<SceneSighting>& seen, std::size_t frame) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (std::size_t k = 0; k < clusters_.size(); ++k) {
        if (clusters_[k].class_index != seen[i].object.class_index) continue;
        const Eigen::Vector3d apart_m = seen[i].object.position_m - clusters_[k].position_m;
        const Eigen::Matrix3d cov_m2 = clusters_[k].cov_m2 + seen[i].object.cov_m2 + seen[i].drift_m2;
        const double distance_sq = distanceOf(apart_m, cov_m2, min_merge_radius_m_);
        if (std::isfinite(distance_sq)) pairs.emplace_back(distance_sq, i, k);
      }
    }
    std::sort(pairs.begin(), pairs.end());
    std::vector<char> is_known(seen.size(), 0);
    std::vector<char> is_seen(clusters_.size(), 0);
    for (const auto& [distance_sq, i, k] : pairs) {
      if (is_known[i] != 0 || is_seen[k] != 0) continue;
      is_known[i] = is_seen[k] = 1;
      clusters_[k].add(seen[i], frame);
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      if (is_known[i] != 0) continue;
      clusters_.emplace_back().class_index = seen[i].object.class_index;
      clusters_.back().add(seen[i], frame);
    }
  }

  /// Joins what no frame shows as two, the nearest first.
  void joinTheSame() {
    while (true) {
      double least = std::numeric_limits<double>::infinity();
      std::size_t best_i = 0;
      std::size_t best_k = 0;
      for (std::size_t i = 0; i < clusters_.size(); ++i) {
        for (std::size_t k = i + 1; k < clusters_.size(); ++k) {
          const double distance_sq = distanceBetween(clusters_[i], clusters_[k]);
          if (distance_sq < least) std::tie(least, best_i, best_k) = std::tie(distance_sq, i, k);
        }
      }
      if (!std::isfinite(least)) return;
      Cluster& kept = clusters_[best_i];
      if (clusters_[best_k].frames.size() > kept.frames.size()) kept.class_index = clusters_[best_k].class_index;
      kept.add(clusters_[best_k]);
      clusters_.erase(clusters_.begin() + static_cast<std::ptrdiff_t>(best_k));
    }
  }

  Scene scene(std::size_t least_sightings) const {
    Scene scene;
    for (const Cluster& cluster : clusters_) {
      if (cluster.frames.size() < least_sightings) continue;
      SceneObject object;
      object.position_m = cluster.position_m;
      object.cov_m2 = cluster.cov_m2;
      object.class_index = cluster.class_index;
      scene.objects.push_back(object);
    }
    return scene;
  }

 private:
  double distanceBetween(const Cluster& a, const Cluster& b) const {
    const auto fewer = static_cast<double>(std::min(a.frames.size(), b.frames.size()));
    const auto more = static_cast<double>(std::max(a.frames.size(), b.frames.size()));
    const bool may_be_one = a.class_index == b.class_index || fewer < kMistaken * more;
    if (!may_be_one || areSeenTogether(a, b)) return std::numeric_limits<double>::infinity();
    return distanceOf(a.position_m - b.position_m, a.cov_m2 + b.cov_m2, min_merge_radius_m_);
  }

  double min_merge_radius_m_;
  std::vector<Cluster> clusters_;
};

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

Scene accumulateScene(const std::vector<SeenFrame>& frames, const ClassTable& classes, double min_merge_radius_m) {
  Accumulation accumulation(min_merge_radius_m);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    std::vector<SceneSighting> seen;
    for (const SceneObject& object : sceneOfFrame(frames[i].detections, classes).objects) {
      seen.push_back(sightingOf(object, frames[i]));
    }
    accumulation.add(seen, i);
  }
  accumulation.joinTheSame();
  return accumulation.scene(frames.size() >= kLongWindow ? 2 : 1);
}

}  // namespace semantic_mht_slam
