#pragma once

#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// Id 1, trees.
inline ClassTable makeOrchardClasses() {
  std::vector<ClassInfo> classes(1);
  classes[0].id = 1;
  classes[0].name = "tree";
  return ClassTable(classes, "test");
}

/// Up and down the lanes of an orchard, and back along all of them: trees on a grid, which looks the same one tree
/// further on. The heading of the odometry drifts.
class OrchardDrive {
 public:
  static constexpr double kTrees_m = 4.0;  ///< along a row
  static constexpr double kRows_m = 5.0;
  static constexpr int kRows = 7;
  static constexpr int kTreesOfRow = 20;

  OrchardDrive(std::uint64_t seed, double drift_rad_per_m) : drift_rad_per_m_(drift_rad_per_m), rng_(seed) {
    for (int row = 0; row < kRows; ++row) {
      for (int tree = 0; tree < kTreesOfRow; ++tree) {
        trees_m_.push_back(
            {kTrees_m * tree + rng_.normal(0.0, 0.08), kRows_m * (row - 0.5) + rng_.normal(0.0, 0.08), 0.5});
      }
    }
    const double length_m = kTrees_m * (kTreesOfRow - 1);
    std::vector<Eigen::Vector2d> way = {{-4.0, 0.0}};
    for (int lane = 0; lane + 1 < kRows; ++lane) {
      const bool is_out = lane % 2 == 0;
      way.emplace_back(is_out ? -4.0 : length_m + 4.0, kRows_m * lane);
      way.emplace_back(is_out ? length_m + 4.0 : -4.0, kRows_m * lane);
    }
    for (std::size_t i = way.size(); i-- > 0;) way.push_back(way[i]);
    for (std::size_t i = 1; i < way.size(); ++i) driveTo(way[i - 1], way[i]);
    follow();
  }

  /// Drives the whole way.
  void feed(Slam& slam) {
    for (std::size_t i = 0; i < truth_.size(); ++i) {
      const Stamp stamp = 500000000LL * static_cast<Stamp>(i + 1);
      slam.addOdometry({stamp, odometry_[i]});
      slam.addDetections(stamp, detectionsAt(i));
    }
    slam.finish();
  }

  std::size_t trees() const { return trees_m_.size(); }

  /// Which trees the detections of each landmark show, more than once.
  std::map<LandmarkId, std::set<int>> treesOfLandmarks(const Slam& slam) const {
    std::map<LandmarkId, std::map<int, int>> shown;
    for (const auto& [frame, row, landmark, probability] : slam.map().associations()) {
      const int tree = tree_of_row_.at(frame)[static_cast<std::size_t>(row)];
      if (landmark != kNoLandmark) ++shown[landmark][tree];
    }
    std::map<LandmarkId, std::set<int>> trees;
    for (const auto& [landmark, counts] : shown) {
      for (const auto& [tree, count] : counts) {
        if (count > 3) trees[landmark].insert(tree);
      }
    }
    return trees;
  }

 private:
  /// One frame a metre; turns on the spot.
  void driveTo(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    const double distance_m = (to - from).norm();
    if (distance_m < 0.1) return;
    const Eigen::Vector2d step = (to - from) / distance_m;
    const Eigen::Quaterniond heading = expRotation({0.0, 0.0, std::atan2(step.y(), step.x())});
    for (double s = 0.0; s < distance_m; s += 1.0) {
      truth_.push_back({heading, {from.x() + s * step.x(), from.y() + s * step.y(), 0.0}});
    }
  }

  void follow() {
    odometry_.push_back(truth_.front());
    for (std::size_t i = 1; i < truth_.size(); ++i) {
      const Pose step = truth_[i - 1].inverse() * truth_[i];
      const Pose drift{expRotation({0.0, 0.0, drift_rad_per_m_ + rng_.normal(0.0, 0.0005)}), {0.0, 0.0, 0.0}};
      odometry_.push_back(odometry_.back() * step * drift);
    }
  }

  Detections detectionsAt(std::size_t i) {
    const Pose T_base_map = truth_[i].inverse();
    Detections detections;
    tree_of_row_.emplace_back();
    for (std::size_t k = 0; k < trees_m_.size(); ++k) {
      const Eigen::Vector3d seen_m = T_base_map * trees_m_[k];
      if (seen_m.norm() > 12.0 || !rng_.bernoulli(0.85)) continue;
      Detection detection;
      for (int axis = 0; axis < 3; ++axis) detection.position_m[axis] = seen_m[axis] + rng_.normal(0.0, 0.1);
      detection.row = static_cast<int>(detections.size());
      detections.push_back(detection);
      tree_of_row_.back().push_back(static_cast<int>(k));
    }
    return detections;
  }

  double drift_rad_per_m_;
  Rng rng_;
  std::vector<Eigen::Vector3d> trees_m_;
  std::vector<Pose> truth_;
  std::vector<Pose> odometry_;
  std::vector<std::vector<int>> tree_of_row_;  ///< of each frame
};

}  // namespace semantic_mht_slam
