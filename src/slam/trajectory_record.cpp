#include "semantic_mht_slam/slam/trajectory_record.h"

#include <algorithm>
#include <optional>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/graph/trajectory_correction.h"
#include "semantic_mht_slam/slam/map_uncertainty.h"

namespace semantic_mht_slam {
namespace {

using Samples = std::vector<StampedPose>::const_iterator;

/// A fix, carried on to the odometry sample that follows it.
struct AnchoredFix {
  CorrectionAnchor anchor;
  FixedAxesCov cov;
};

std::vector<AnchoredFix> anchored(Samples begin, Samples end, std::vector<MapFix> fixes) {
  std::stable_sort(fixes.begin(), fixes.end(), [](const MapFix& a, const MapFix& b) { return a.stamp < b.stamp; });
  std::vector<AnchoredFix> anchors;
  for (const MapFix& fix : fixes) {
    const auto sample = std::lower_bound(begin, end, fix.stamp,
                                         [](const StampedPose& pose, Stamp stamp) { return pose.stamp < stamp; });
    if (sample == end) continue;
    const std::size_t index = sample - begin;
    if (!anchors.empty() && anchors.back().anchor.index >= index) continue;
    const Pose T_map_base = fix.T_map_base * (fix.T_odom_base.inverse() * sample->T_world_base);
    const Eigen::Vector3d lever_m = T_map_base.translation_m - fix.T_map_base.translation_m;
    anchors.push_back({{index, T_map_base}, carried(fix.cov, lever_m)});
  }
  return anchors;
}

/// A session of a record.
struct Stretch {
  Samples begin;
  Samples end;
  std::vector<AnchoredFix> anchors;
  bool is_first = false;
};

std::vector<Stretch> stretchesOf(const TrajectoryRecord& record) {
  std::vector<Stretch> stretches;
  for (std::size_t s = 0; s < record.sessions.size(); ++s) {
    const auto at = [&](std::size_t i) { return record.odometry.begin() + i; };
    const bool is_last = s + 1 == record.sessions.size();
    const Samples begin = at(record.sessions[s].first_odometry);
    const Samples end = is_last ? record.odometry.end() : at(record.sessions[s + 1].first_odometry);
    stretches.push_back({begin, end, anchored(begin, end, record.sessions[s].fixes), s == 0});
  }
  return stretches;
}

std::vector<Pose> posesOf(const Stretch& stretch) {
  std::vector<Pose> poses;
  poses.reserve(stretch.end - stretch.begin);
  for (Samples sample = stretch.begin; sample != stretch.end; ++sample) poses.push_back(sample->T_world_base);
  std::vector<CorrectionAnchor> anchors;
  for (const AnchoredFix& fix : stretch.anchors) anchors.push_back(fix.anchor);
  return anchors.empty() ? poses : correctTrajectory(poses, anchors);
}

/// Covariances along poses that follow from the first one by odometry, forwards or backwards.
template <class Iterator, class Output>
void reckon(Iterator begin, Iterator end, const FixedAxesCov& first_cov, const OdometryModel& odometry, Output output) {
  if (begin == end) return;
  UncertainPose pose{*begin, first_cov};
  *output++ = pose.total();
  for (Iterator next = begin + 1; next != end; ++next) {
    pose = reckoned(pose, pose.T_world_base.inverse() * *next, odometry);
    *output++ = pose.total();
  }
}

/// Between two fixes. The mean of two covariances is that of the mean pose and what the two do not share, which stands
/// for the way between them.
void fillBetween(const AnchoredFix& before, const AnchoredFix& after, const std::vector<Pose>& poses,
                 std::vector<FixedAxesCov>& covs) {
  const auto length = static_cast<double>(after.anchor.index - before.anchor.index);
  for (std::size_t i = before.anchor.index; i < after.anchor.index; ++i) {
    const double fraction = static_cast<double>(i - before.anchor.index) / length;
    const auto from = [&](const AnchoredFix& fix) {
      return carried(fix.cov, poses[i].translation_m - fix.anchor.T_map_base.translation_m);
    };
    covs[i] = symmetric((1.0 - fraction) * from(before) + fraction * from(after));
  }
}

std::vector<FixedAxesCov> covariancesOf(const Stretch& stretch, const OdometryModel& odometry) {
  const std::vector<Pose> poses = posesOf(stretch);
  std::vector<FixedAxesCov> covs(poses.size(), unknownPoseCov());
  if (stretch.anchors.empty()) {
    if (stretch.is_first) reckon(poses.begin(), poses.end(), gaugeCov(), odometry, covs.begin());
    return covs;
  }
  const AnchoredFix& first = stretch.anchors.front();
  const AnchoredFix& last = stretch.anchors.back();
  const auto first_index = static_cast<std::ptrdiff_t>(first.anchor.index);
  const auto last_index = static_cast<std::ptrdiff_t>(last.anchor.index);
  if (stretch.is_first) {
    reckon(poses.begin(), poses.begin() + first_index, gaugeCov(), odometry, covs.begin());
  } else {
    reckon(poses.rend() - first_index - 1, poses.rend(), first.cov, odometry, covs.rend() - first_index - 1);
  }
  for (std::size_t k = 1; k < stretch.anchors.size(); ++k) {
    fillBetween(stretch.anchors[k - 1], stretch.anchors[k], poses, covs);
  }
  reckon(poses.begin() + last_index, poses.end(), last.cov, odometry, covs.begin() + last_index);
  return covs;
}

}  // namespace

std::vector<StampedPose> trajectoryOf(const TrajectoryRecord& record) {
  std::vector<StampedPose> trajectory;
  trajectory.reserve(record.odometry.size());
  for (const Stretch& stretch : stretchesOf(record)) {
    const std::vector<Pose> poses = posesOf(stretch);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      trajectory.push_back({stretch.begin[i].stamp, poses[i]});
    }
  }
  return trajectory;
}

std::vector<FixedAxesCov> trajectoryCovOf(const TrajectoryRecord& record, const OdometryModel& odometry) {
  std::vector<FixedAxesCov> result;
  for (const Stretch& stretch : stretchesOf(record)) {
    const std::vector<FixedAxesCov> covs = covariancesOf(stretch, odometry);
    result.insert(result.end(), covs.begin(), covs.end());
  }
  return result;
}

}  // namespace semantic_mht_slam
