#include "semantic_mht_slam/graph/trajectory_correction.h"

#include <algorithm>
#include <stdexcept>

namespace semantic_mht_slam {
namespace {

void check(std::size_t poses, const std::vector<CorrectionAnchor>& anchors) {
  if (anchors.empty()) throw std::invalid_argument("correctTrajectory: no anchor");
  for (std::size_t i = 0; i < anchors.size(); ++i) {
    if (anchors[i].index >= poses || (i > 0 && anchors[i].index <= anchors[i - 1].index)) {
      throw std::invalid_argument("correctTrajectory: anchor indices must ascend within the odometry");
    }
  }
}

/// Distance travelled up to every pose.
std::vector<double> travelledDistance(const std::vector<Pose>& poses) {
  std::vector<double> distance_m(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    distance_m[i] = distance_m[i - 1] + (poses[i].translation_m - poses[i - 1].translation_m).norm();
  }
  return distance_m;
}

}  // namespace

std::vector<Pose> correctTrajectory(const std::vector<Pose>& odometry, const std::vector<CorrectionAnchor>& anchors) {
  check(odometry.size(), anchors);
  const std::vector<double> distance_m = travelledDistance(odometry);
  std::vector<Pose> corrected;
  corrected.reserve(odometry.size());
  std::size_t next = 0;  // first anchor behind the present pose
  for (std::size_t i = 0; i < odometry.size(); ++i) {
    while (next < anchors.size() && anchors[next].index <= i) ++next;
    const auto from_anchor = [&](const CorrectionAnchor& anchor) {
      return anchor.T_map_base * (odometry[anchor.index].inverse() * odometry[i]);
    };
    if (next == 0 || next == anchors.size()) {
      corrected.push_back(from_anchor(next == 0 ? anchors.front() : anchors.back()));
      continue;
    }
    const CorrectionAnchor& before = anchors[next - 1];
    const CorrectionAnchor& after = anchors[next];
    const double length_m = distance_m[after.index] - distance_m[before.index];
    const double fraction =
        length_m > 0.0 ? (distance_m[i] - distance_m[before.index]) / length_m
                       : static_cast<double>(i - before.index) / static_cast<double>(after.index - before.index);
    corrected.push_back(interpolate(from_anchor(before), from_anchor(after), std::clamp(fraction, 0.0, 1.0)));
  }
  return corrected;
}

}  // namespace semantic_mht_slam
