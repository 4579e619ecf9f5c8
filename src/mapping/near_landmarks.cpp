#include "semantic_mht_slam/mapping/near_landmarks.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

namespace semantic_mht_slam {
namespace {

/// A detection with the landmark that it shows.
struct Shown {
  LandmarkId landmark;
  Eigen::Vector3d position_m;
  Eigen::Matrix3d cov_m2;
  double radius_m;  ///< half of the object's largest horizontal extent; 0 if the detector does not tell
  double reach_m;   ///< nothing further away than the sum of both is near
};

Shown shown(const Detection& detection, LandmarkId landmark, double gate_mahalanobis_sq) {
  const Eigen::Matrix3d& cov_m2 = detection.cov_m2.value();
  const double radius_m = detection.size_m ? 0.5 * detection.size_m->head<2>().maxCoeff() : 0.0;
  return {landmark, detection.position_m, cov_m2, radius_m, radius_m + std::sqrt(gate_mahalanobis_sq * cov_m2.trace())};
}

bool areNear(const Shown& a, const Shown& b, double gate_mahalanobis_sq) {
  const Eigen::Vector3d d = a.position_m - b.position_m;
  const double distance_m = d.norm();
  if (distance_m > a.reach_m + b.reach_m) return false;
  const double explained_m = a.radius_m + b.radius_m;
  if (distance_m <= explained_m) return true;
  const Eigen::Vector3d rest = (1.0 - explained_m / distance_m) * d;
  return rest.dot((a.cov_m2 + b.cov_m2).llt().solve(rest)) < gate_mahalanobis_sq;
}

/// Whether all detections of one landmark are near all of the other.
bool areAllNear(const std::vector<Shown>& frame, const SameLandmark& pair, double gate_mahalanobis_sq) {
  for (const Shown& a : frame) {
    for (const Shown& b : frame) {
      const bool is_pair = a.landmark == pair.first && b.landmark == pair.second;
      if (is_pair && !areNear(a, b, gate_mahalanobis_sq)) return false;
    }
  }
  return true;
}

std::vector<SameLandmark> nearPairs(const std::vector<Shown>& frame, double gate_mahalanobis_sq) {
  std::vector<SameLandmark> pairs;
  for (std::size_t i = 0; i < frame.size(); ++i) {
    for (std::size_t k = i + 1; k < frame.size(); ++k) {
      const Shown& a = frame[i];
      const Shown& b = frame[k];
      if (std::abs(a.position_m.x() - b.position_m.x()) > a.reach_m + b.reach_m) continue;
      if (a.landmark == b.landmark || !areNear(a, b, gate_mahalanobis_sq)) continue;
      const SameLandmark pair{std::min(a.landmark, b.landmark), std::max(a.landmark, b.landmark)};
      if (areAllNear(frame, pair, gate_mahalanobis_sq)) pairs.push_back(pair);
    }
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

}  // namespace

std::vector<NearLandmarks> findNearLandmarks(const std::vector<Frame>& frames,
                                             const std::vector<DetectionAssociation>& associations,
                                             double gate_mahalanobis_sq) {
  std::map<SameLandmark, int> frames_of;
  auto association = associations.begin();
  for (const Frame& frame : frames) {
    std::vector<Shown> of_frame;
    for (const Detection& detection : frame.detections) {
      const LandmarkId landmark = (association++)->landmark;
      if (landmark != kNoLandmark) of_frame.push_back(shown(detection, landmark, gate_mahalanobis_sq));
    }
    for (const SameLandmark& pair : nearPairs(of_frame, gate_mahalanobis_sq)) ++frames_of[pair];
  }
  std::vector<NearLandmarks> near;
  for (const auto& [pair, count] : frames_of) near.push_back({pair.first, pair.second, count});
  return near;
}

}  // namespace semantic_mht_slam
