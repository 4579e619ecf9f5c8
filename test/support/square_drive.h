#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// Ids 1 and 2.
inline ClassTable makeStreetClasses(const std::string& second = "trunk") {
  std::vector<ClassInfo> classes(2);
  classes[0].id = 1;
  classes[0].name = "pole";
  classes[1].id = 2;
  classes[1].name = second;
  return ClassTable(classes, "test");
}

/// Rounds of a square of 120 m in a street with poles and trunks, 1 m a frame, odometry that drifts.
class SquareDrive {
 public:
  static constexpr int kNever_m = 1000000;

  /// After `leaves_m`, which must be in a first side, the drive goes straight on for ever.
  explicit SquareDrive(std::uint64_t seed, int leaves_m = kNever_m) : leaves_m_(leaves_m), rng_(seed) {
    for (int i = 0; i < 160; ++i) addLandmark(poseAt(3.0 * i), i);
    for (int i = 0; leaves_m < kNever_m && i < 160; ++i) addLandmark(straightOn(120.0 + 3.0 * i), i);
  }

  static Stamp stampAt(int i) { return 100000000LL * (i + 1); }

  /// T_odom_base at frame `i` of a drive that never leaves the square.
  static Pose odometryAt(int i) { return driftAt(i) * poseAt(1.0 * i); }

  /// Where the vehicle is at frame `i`.
  Pose truthAt(int i) const {
    return i > leaves_m_ ? straightOn(std::fmod(leaves_m_, 480.0) + i - leaves_m_) : poseAt(1.0 * i);
  }

  /// What is seen from frame `i`, stamped 0.03 s before it.
  Detections detectionsAt(int i) const {
    Rng rng = rng_.fork("frame", static_cast<std::uint64_t>(i));
    const Pose T_base_map = truthAt(i).inverse();
    Detections detections;
    for (std::size_t k = 0; k < landmarks_m_.size(); ++k) {
      const Eigen::Vector3d seen_m = T_base_map * landmarks_m_[k];
      if (seen_m.norm() > 30.0 || !rng.bernoulli(0.8)) continue;
      Detection detection;
      detection.class_index = k % 3 == 0 ? 1 : 0;
      for (int axis = 0; axis < 3; ++axis) detection.position_m[axis] = seen_m[axis] + rng.normal(0.0, 0.1);
      detection.row = static_cast<int>(detections.size());
      detections.push_back(detection);
    }
    return detections;
  }

  /// Feeds frames [begin, end) to the estimator.
  void feed(Slam& slam, int begin, int end) const {
    for (int i = begin; i < end; ++i) {
      slam.addOdometry({stampAt(i), driftAt(i) * truthAt(i)});
      slam.addDetections(stampAt(i) - 30000000, detectionsAt(i));
    }
  }

 private:
  static Pose driftAt(int i) { return {expRotation({0.0, 0.0, 2e-5 * i}), {2e-3 * i, 0.0, 0.0}}; }
  static Pose straightOn(double along_m) { return {Eigen::Quaterniond::Identity(), {along_m, 0.0, 0.0}}; }

  void addLandmark(const Pose& there, int i) {
    const double side_m = (i % 2 == 0 ? 1.0 : -1.0) * rng_.uniform(4.0, 12.0);
    landmarks_m_.push_back(there * Eigen::Vector3d(rng_.uniform(-1.0, 1.0), side_m, 0.0));
  }

  static Pose poseAt(double along_m) {
    const double side = std::fmod(along_m, 480.0) / 120.0;
    const double in_side_m = 120.0 * (side - std::floor(side));
    const double heading = 0.5 * M_PI * std::floor(side);
    const Eigen::Vector3d corners[] = {{0, 0, 0}, {120, 0, 0}, {120, 120, 0}, {0, 120, 0}};
    const Pose corner{expRotation({0.0, 0.0, heading}), corners[static_cast<int>(side)]};
    return corner * Pose{Eigen::Quaterniond::Identity(), {in_side_m, 0.0, 0.0}};
  }

  int leaves_m_;
  Rng rng_;
  std::vector<Eigen::Vector3d> landmarks_m_;
};

}  // namespace semantic_mht_slam
