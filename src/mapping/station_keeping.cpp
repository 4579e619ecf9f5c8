#include "semantic_mht_slam/mapping/station_keeping.h"

#include <algorithm>

namespace semantic_mht_slam {
namespace {

constexpr double kTurn_rad = 0.4;       // between two stations
constexpr double kNear = 0.2;           // of the way and of the turn to the next: still the same station
constexpr std::size_t kEnough = 8;      // detections of a station
constexpr std::size_t kMostSteps = 12;  // of a piece; bounds time

}  // namespace

void StationKeeping::add(std::size_t place, const Pose& T_submap_base, const Motion& motion,
                         const Detections& detections, double spacing_m) {
  const Motion since = stations_.empty() ? Motion{} : motion - stations_.back().motion;
  const double share = std::max(since.way_m / spacing_m, since.turn_rad / kTurn_rad);
  if (stations_.empty() || share >= 1.0) {
    stations_.push_back({T_submap_base, motion, {}});
  } else if (share > kNear || stations_.back().seen.size() >= kEnough) {
    return;
  }
  Station& station = stations_.back();
  const Pose T_station_base = station.T_submap_base.inverse() * T_submap_base;
  for (std::size_t i = 0; i < detections.size(); ++i) station.seen.push_back({place, i, T_station_base, detections[i]});
}

std::vector<OdometryStretch> StationKeeping::stretches(const std::vector<FusedAssociations>& associations,
                                                       const Corrected& corrected) const {
  std::vector<OdometryStretch> result;
  for (std::size_t first = 0; first + 1 < stations_.size(); first += kMostSteps) {
    const std::size_t end = std::min(stations_.size(), first + kMostSteps + 1);
    OdometryStretch& stretch = result.emplace_back();
    for (std::size_t k = first; k < end; ++k) {
      const Station& station = stations_[k];
      if (k > first) stretch.motion.push_back(station.motion - stations_[k - 1].motion);
      stretch.T_stretch_base.push_back(station.T_submap_base);
      for (const Seen& seen : station.seen) {
        const LandmarkId landmark = associations.at(seen.place).landmark_of_measurement.at(seen.measurement);
        if (landmark == kNoLandmark) continue;
        const std::optional<Detection> detection = corrected(seen.detection);
        if (!detection) continue;
        const Eigen::Matrix3d R = seen.T_station_base.rotation.toRotationMatrix();
        stretch.observations.push_back({static_cast<int>(k - first), seen.T_station_base * detection->position_m,
                                        R * *detection->cov_m2 * R.transpose(), landmark});
      }
    }
  }
  return result;
}

}  // namespace semantic_mht_slam
