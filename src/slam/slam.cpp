#include "semantic_mht_slam/slam/slam.h"

#include <utility>

namespace semantic_mht_slam {

void describe(SlamConfig& config, Fields& fields) {
  fields.add<Method>("method", config.method, {{"odometry", Method::kOdometry}}, "How the trajectory is estimated.");
  fields.group("input", config.input);
}

Slam::Slam(const SlamConfig& config) : assembler_(config.input) {}

bool Slam::addOdometry(const StampedPose& T_odom_base) {
  if (!assembler_.addOdometry(T_odom_base)) return false;
  odometry_.push_back(T_odom_base);
  processReadyFrames();
  return true;
}

void Slam::addDetections(Stamp stamp, Detections detections) {
  assembler_.addDetections(stamp, std::move(detections));
  processReadyFrames();
}

void Slam::processReadyFrames() {
  while (auto frame = assembler_.next()) latest_frame_ = std::move(frame);
}

std::vector<StampedPose> Slam::trajectory() const {
  std::vector<StampedPose> trajectory;
  trajectory.reserve(odometry_.size());
  for (const auto& [stamp, T_odom_base] : odometry_) trajectory.push_back({stamp, T_map_odom() * T_odom_base});
  return trajectory;
}

std::optional<StampedPose> Slam::latestPose() const {
  if (odometry_.empty()) return std::nullopt;
  return StampedPose{odometry_.back().stamp, T_map_odom() * odometry_.back().T_world_base};
}

}  // namespace semantic_mht_slam
