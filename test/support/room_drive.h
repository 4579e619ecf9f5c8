#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "semantic_mht_slam/common/random.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// Ids 1 to 3: chairs, tables, doors.
inline ClassTable makeRoomClasses() {
  std::vector<ClassInfo> classes(3);
  const char* const names[] = {"chair", "table", "door"};
  for (int i = 0; i < 3; ++i) {
    classes[i].id = i + 1;
    classes[i].name = names[i];
    classes[i].range_stddev_m = 0.1;
    classes[i].lateral_stddev_m = 0.05;
  }
  return ClassTable(classes, "test");
}

/// A robot that turns on the spot, in a room of 10 m with four groups of two tables and four chairs; its camera looks
/// ahead and sees a few objects at a time. Frame 0 is its start; rounds repeat.
class RoomDrive {
 public:
  explicit RoomDrive(std::uint64_t seed) : rng_(seed) {
    for (const auto& [x, y] : {std::pair(2.7, 2.7), {7.3, 2.6}, {2.6, 7.4}, {7.4, 7.2}}) {
      const Pose T_room_group{expRotation({0.0, 0.0, rng_.uniform(-0.3, 0.3)}), {x, y, 0.0}};
      for (const double dx : {-0.6, 0.6}) place(1, T_room_group, {dx, 0.0, 0.72});
      for (const double dx : {-0.7, 0.7}) {
        for (const double dy : {-0.85, 0.85}) place(0, T_room_group, {dx, dy, 0.45});
      }
    }
    for (const auto& [x, y] : {std::pair(0.0, 5.2), {0.0, 1.6}, {10.0, 3.4}, {10.0, 8.1}, {4.2, 10.0}, {6.9, 0.0}}) {
      place(2, Pose::identity(), {x, y, 1.0});
    }
  }

  /// Drives rounds and ends at the start.
  void feed(Slam& slam, int rounds) {
    Pose T_room_base{Eigen::Quaterniond::Identity(), {1.0, 1.0, 0.0}};
    Pose T_odom_base = Pose::identity();
    frames_ = 0;
    add(slam, T_room_base, T_odom_base);
    for (int i = 0; i < rounds; ++i) {
      for (const auto& [x, y] : {std::pair(9.0, 1.0), {9.0, 9.0}, {5.0, 9.0}, {5.0, 5.0}, {1.0, 9.0}, {1.0, 1.0}}) {
        driveTo({x, y}, slam, T_room_base, T_odom_base);
      }
    }
    slam.finish();
  }

  std::size_t objects() const { return objects_.size(); }

  /// Of the newest session, horizontal, in the map of a first drive, which began at the origin.
  double largestErrorFrom(double driven_m) const {
    double largest_m = 0.0;
    for (const auto& [at_m, error_m] : errors_) largest_m = at_m >= driven_m ? std::max(largest_m, error_m) : largest_m;
    return largest_m;
  }

  void beginSession() {
    errors_.clear();
    driven_m_ = 0.0;
  }

 private:
  struct Object {
    ClassIndex class_index;
    Eigen::Vector3d position_m;
  };

  void place(ClassIndex class_index, const Pose& T_room_group, const Eigen::Vector3d& at_m) {
    const Eigen::Vector3d shift_m(rng_.normal(0.0, 0.1), rng_.normal(0.0, 0.1), 0.0);
    objects_.push_back({class_index, T_room_group * at_m + shift_m});
  }

  void driveTo(const Eigen::Vector2d& goal_m, Slam& slam, Pose& T_room_base, Pose& T_odom_base) {
    const Eigen::Vector3d ahead_m = T_room_base.inverse() * Eigen::Vector3d(goal_m.x(), goal_m.y(), 0.0);
    const double turn_rad = std::atan2(ahead_m.y(), ahead_m.x());
    const int turns = std::max(1, static_cast<int>(std::ceil(std::abs(turn_rad) / 0.15)));
    for (int i = 0; i < turns; ++i) step(0.0, turn_rad / turns, slam, T_room_base, T_odom_base);
    const int steps = static_cast<int>(std::ceil(ahead_m.norm() / 0.1));
    for (int i = 0; i < steps; ++i) step(ahead_m.norm() / steps, 0.0, slam, T_room_base, T_odom_base);
  }

  void step(double way_m, double turn_rad, Slam& slam, Pose& T_room_base, Pose& T_odom_base) {
    T_room_base = T_room_base * Pose{expRotation({0.0, 0.0, turn_rad}), {way_m, 0.0, 0.0}};
    const double error_rad = 0.01 * turn_rad + 0.01 * std::sqrt(way_m) * rng_.normal();
    T_odom_base = T_odom_base * Pose{expRotation({0.0, 0.0, turn_rad + error_rad}), {1.01 * way_m, 0.0, 0.0}};
    driven_m_ += way_m;
    add(slam, T_room_base, T_odom_base);
  }

  void add(Slam& slam, const Pose& T_room_base, const Pose& T_odom_base) {
    const Stamp stamp = 200000000LL * ++frames_;
    slam.addOdometry({stamp, T_odom_base});
    Detections detections;
    for (const Object& object : objects_) {
      const Eigen::Vector3d seen_m = T_room_base.inverse() * object.position_m;
      const double range_m = seen_m.head<2>().norm();
      const bool is_in_view = range_m > 0.5 && range_m < 5.0 && std::abs(std::atan2(seen_m.y(), seen_m.x())) < M_PI_4;
      if (!is_in_view || !rng_.bernoulli(0.8)) continue;
      const Eigen::Vector3d ray = Eigen::Vector3d(seen_m.x(), seen_m.y(), 0.0) / range_m;
      const Eigen::Vector3d across(-ray.y(), ray.x(), 0.0);
      Detection detection;
      detection.row = static_cast<int>(detections.size());
      detection.class_index = rng_.bernoulli(0.03) ? (object.class_index + 1) % 3 : object.class_index;
      detection.position_m =
          seen_m + (0.03 + 0.02 * range_m) * rng_.normal() * ray + (0.02 + 0.008 * range_m) * rng_.normal() * across;
      detections.push_back(detection);
    }
    slam.addDetections(stamp, std::move(detections));
    const Pose T_map_base{T_room_base.rotation, T_room_base.translation_m - Eigen::Vector3d(1.0, 1.0, 0.0)};
    const Eigen::Vector3d error_m = latestPoseOf(slam)->T_world_base.translation_m - T_map_base.translation_m;
    errors_.emplace_back(driven_m_, error_m.head<2>().norm());
  }

  Rng rng_;
  std::vector<Object> objects_;
  std::vector<std::pair<double, double>> errors_;  ///< way driven in the session, error there
  double driven_m_ = 0.0;
  std::int64_t frames_ = 0;
};

}  // namespace semantic_mht_slam
