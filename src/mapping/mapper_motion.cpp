#include <optional>

#include "semantic_mht_slam/mapping/mapper.h"

// How far the vehicle moved in a submap, and what that says of its odometry.
namespace semantic_mht_slam {
namespace {

constexpr double kFramesPerSubmap = 15.0;   // nearer ones see the same error of a centroid
constexpr double kStationsPerSubmap = 6.0;  // where the odometry is compared with what is seen

}  // namespace

bool Mapper::isFullAt(const Pose& T_odom_base) const {
  if (frames_.empty()) return false;
  const Motion motion = motionWith(T_odom_base);
  return motion.way_m >= config_.submap.length_m || motion.turn_rad >= config_.submap.turn_rad ||
         static_cast<int>(frames_.size()) >= config_.submap.max_frames;
}

/// Since the submap began, with a step to where the odometry is.
Motion Mapper::motionWith(const Pose& T_odom_base) const {
  return frames_.empty() ? Motion{} : motion_ + motionOf(frames_.back().T_odom_base.inverse() * T_odom_base);
}

double Mapper::frameSpacing_m() const {
  return config_.submap.length_m / kFramesPerSubmap;
}

double Mapper::stationSpacing_m() const {
  return config_.submap.length_m / kStationsPerSubmap;
}

void Mapper::learnOdometry(const std::vector<FusedAssociations>& associations) {
  const auto corrected = [this](const Detection& detection) -> std::optional<Detection> {
    if (!bias_.hasOnePlace(detection.class_index)) return std::nullopt;
    Detection result = bias_.corrected(detection);
    result.cov_m2 = detectorCov(detection);
    result.cov_m2->diagonal().head<2>().array() +=
        stationSpacing_m() * calibration_.wanderVariancePerMetre(detection.class_index);
    return result;
  };
  for (const OdometryStretch& stretch : stations_.stretches(associations, corrected)) odometry_.add(stretch);
}

}  // namespace semantic_mht_slam
