#include "semantic_mht_slam/slam/trajectory_record.h"

#include <algorithm>

#include "semantic_mht_slam/graph/trajectory_correction.h"

namespace semantic_mht_slam {
namespace {

using Samples = std::vector<StampedPose>::const_iterator;

/// Each fix, carried on to the odometry sample that follows it.
std::vector<CorrectionAnchor> correctionAnchors(Samples begin, Samples end, std::vector<MapFix> fixes) {
  std::stable_sort(fixes.begin(), fixes.end(), [](const MapFix& a, const MapFix& b) { return a.stamp < b.stamp; });
  std::vector<CorrectionAnchor> anchors;
  for (const MapFix& fix : fixes) {
    const auto sample = std::lower_bound(begin, end, fix.stamp,
                                         [](const StampedPose& pose, Stamp stamp) { return pose.stamp < stamp; });
    if (sample == end) continue;
    const std::size_t index = sample - begin;
    if (!anchors.empty() && anchors.back().index >= index) continue;
    const Pose T_fix_base = fix.T_odom_base.inverse() * sample->T_world_base;
    anchors.push_back({index, fix.T_map_base * T_fix_base});
  }
  return anchors;
}

}  // namespace

std::vector<StampedPose> trajectoryOf(const TrajectoryRecord& record) {
  std::vector<StampedPose> trajectory;
  trajectory.reserve(record.odometry.size());
  for (std::size_t s = 0; s < record.sessions.size(); ++s) {
    const bool is_last = s + 1 == record.sessions.size();
    const auto at = [&](std::size_t i) { return record.odometry.begin() + i; };
    const Samples begin = at(record.sessions[s].first_odometry);
    const Samples end = is_last ? record.odometry.end() : at(record.sessions[s + 1].first_odometry);
    std::vector<Pose> poses;
    poses.reserve(end - begin);
    for (Samples sample = begin; sample != end; ++sample) poses.push_back(sample->T_world_base);
    const auto anchors = correctionAnchors(begin, end, record.sessions[s].fixes);
    if (!anchors.empty()) poses = correctTrajectory(poses, anchors);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      trajectory.push_back({begin[i].stamp, poses[i]});
    }
  }
  return trajectory;
}

}  // namespace semantic_mht_slam
