#include "newest_pose.h"

#include <optional>

#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/mapping/fusion.h"
#include "semantic_mht_slam/slam/surroundings.h"

namespace semantic_mht_slam {
namespace {

constexpr double kMaxPause_s = 60.0;

MapGauge gaugeOf(const SlamParts& parts) {
  return {parts.start_cov, parts.mapper ? parts.mapper->scaleStddev() : 0.0};
}

/// The newest pose follows by odometry from `known`, which was that at the fix.
void tieTo(const MapFix& fix, const UncertainPose& known, SlamParts& parts) {
  UncertainPose pose = known;
  Pose last = fix.T_odom_base;
  for (const StampedPose& sample : parts.sessions.odometryAfter(fix.stamp)) {
    pose = reckoned(pose, last.inverse() * sample.T_world_base, parts.odometry);
    last = sample.T_world_base;
  }
  parts.latest = pose;
}

}  // namespace

void reckon(const StampedPose& next, SlamParts& parts) {
  const std::optional<StampedPose> last = parts.sessions.latestOdometry();
  if (last && parts.latest) {
    parts.latest = reckoned(*parts.latest, last->T_world_base.inverse() * next.T_world_base, parts.odometry);
  } else if (!last && parts.map.keyframes().empty()) {
    parts.latest = UncertainPose{next.T_world_base, gaugeCov()};
  }
}

void tieToNewestKeyframe(SlamParts& parts) {
  const Map& map = parts.map;
  const KeyframeId newest(map.keyframes().size() - 1);
  if (!parts.sessions.isNewestFix(map, newest)) return;
  const Keyframe& keyframe = map.keyframes()[newest];
  tieTo({keyframe.stamp, keyframe.T_odom_base, map.T_map_keyframe(newest)},
        newestKeyframe(map, parts.graph, gaugeOf(parts)), parts);
}

void takeFix(const Localizer& localizer, SlamParts& parts) {
  const Map& map = parts.map;
  const MapUncertainty uncertainty = coarseUncertaintyOf(map, parts.graph, gaugeOf(parts));
  MapFix fix = localizer.fix();
  const Eigen::Vector3d lever_m = fix.T_map_base.translation_m - map.T_map_keyframe(localizer.foundBy()).translation_m;
  fix.cov += carried(uncertainty.keyframes[localizer.foundBy()], lever_m);
  parts.sessions.add(fix);
  tieTo(fix, {fix.T_map_base, fix.cov}, parts);
}

void expectPose(const Pose& T_map_base, double stddev_m, double stddev_rad, SlamParts& parts) {
  FixedAxesCov cov = gaugeCov();
  cov.diagonal().head<3>().array() += stddev_m * stddev_m;
  cov.diagonal().tail<3>().array() += stddev_rad * stddev_rad;
  parts.latest = UncertainPose{T_map_base, cov};
}

void noteStart(SlamParts& parts) {
  const Keyframe& first = parts.map.keyframes()[KeyframeId(0)];
  std::optional<UncertainPose> pose;
  for (const StampedPose& sample : parts.sessions.odometry()) {
    if (sample.stamp > first.stamp) break;
    pose = pose ? reckoned(*pose, pose->T_world_base.inverse() * sample.T_world_base, parts.odometry)
                : UncertainPose{sample.T_world_base, gaugeCov()};
  }
  if (pose) parts.start_cov = pose->total();
}

bool goesOn(const Slam& slam, const StampedPose& next) {
  const std::optional<StampedPose> last = slam.parts().sessions.latestOdometry();
  if (!last || secondsFromStamp(next.stamp - last->stamp) > kMaxPause_s) return false;
  return slam.parts().continuity.goesOn(next);
}

std::optional<StampedPose> latestPoseOf(const Slam& slam) {
  const std::optional<StampedPose> odometry = slam.parts().sessions.latestOdometry();
  if (!odometry) return std::nullopt;
  return StampedPose{odometry->stamp, slam.T_map_odom() * odometry->T_world_base};
}

std::optional<FixedAxesCov> latestCovOf(const Slam& slam) {
  if (!isLocated(slam.mode()) || !slam.parts().latest) return std::nullopt;
  return symmetric(slam.parts().latest->total());
}

MapUncertainty uncertaintyOf(const Slam& slam) {
  return uncertaintyOf(slam.map(), slam.parts().graph, gaugeOf(slam.parts()));
}

std::vector<FixedAxesCov> trajectoryCovOf(const Slam& slam, const MapUncertainty& uncertainty) {
  return trajectoryCovOf(slam.parts().sessions.record(slam.map(), uncertainty), slam.parts().odometry);
}

std::vector<MixtureLandmark> landmarksOf(const Slam& slam) {
  return landmarksOf(slam, coarseUncertaintyOf(slam.map(), slam.parts().graph, gaugeOf(slam.parts())));
}

std::vector<MixtureLandmark> landmarksOf(const Slam& slam, const MapUncertainty& uncertainty) {
  return landmarksOf(slam.map(), slam.parts().graph, uncertainty);
}

std::vector<MixtureLandmark> provisionalLandmarksOf(const Slam& slam) {
  const SlamParts& parts = slam.parts();
  const std::optional<MappedAhead> open = parts.mapper && parts.mapper->isOpen()
                                              ? MappedAhead{parts.mapper->hypotheses(), parts.prediction.prior.T_a_b}
                                              : slam.mapAhead();
  if (!open) return {};
  std::vector<MixtureLandmark> landmarks =
      landmarksBeyond(parts.map, fuseHypotheses(open->hypotheses), open->T_map_submap);
  const UncertainPose here = parts.latest.value_or(UncertainPose{Pose::identity(), unknownPoseCov()});
  for (MixtureLandmark& landmark : landmarks) {
    const Eigen::Vector3d lever_m = landmark.position.mean_m - here.T_world_base.translation_m;
    addPoseShare(here.total(), lever_m, parts.graph.sightingFloor_m(), landmark);
  }
  return landmarks;
}

}  // namespace semantic_mht_slam
