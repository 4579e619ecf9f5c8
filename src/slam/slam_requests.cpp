#include <algorithm>
#include <cmath>
#include <utility>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/gaussian.h"
#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/slam/seen_again.h"
#include "semantic_mht_slam/slam/slam.h"
#include "semantic_mht_slam/slam/surroundings.h"

#include "newest_pose.h"
#include "recent_submaps.h"

// What a person asks of the map.
namespace semantic_mht_slam {
namespace {

constexpr double kStddev_m = 0.5;  // of a closure whose covariance nobody gave
constexpr double kStddev_rad = 3.0 * M_PI / 180.0;
constexpr double kNearStamp_s = 1.0;  // of the poses that a request means
constexpr double kFarthest_m = 1e7;   // a quarter round the Earth
constexpr double kMostInformation = 1e12;

[[noreturn]] void failNoLandmark(LandmarkId name) {
  throw InputError("there is no landmark " + std::to_string(name) + " in the map");
}

/// Half of the distance to the next landmark of the class, and at most `most_m`.
double radiusOfRemoval(const MixtureLandmark& removed, const std::vector<MixtureLandmark>& landmarks, double most_m) {
  double radius_m = most_m;
  for (const MixtureLandmark& other : landmarks) {
    if (other.id == removed.id || other.mostLikelyClass() != removed.mostLikelyClass()) continue;
    const Eigen::Vector3d apart_m = other.position.mean_m - removed.position.mean_m;
    radius_m = std::min(radius_m, 0.5 * apart_m.head<2>().norm());
  }
  return radius_m;
}

/// A pose of the trajectory with the keyframe that it hangs on.
struct TiedPose {
  KeyframeId keyframe;
  Pose T_keyframe_base;
};

/// The pose nearest to a stamp; of several sessions with that stamp the last one if `takes_last`, else the first.
TiedPose tiedPoseAt(Stamp stamp, bool takes_last, const std::vector<StampedPose>& trajectory, const Map& map) {
  const auto isNearer = [&](Stamp a, Stamp b) {
    const Stamp gap_a = std::abs(a - stamp);
    const Stamp gap_b = std::abs(b - stamp);
    return takes_last ? gap_a <= gap_b : gap_a < gap_b;
  };
  const StampedPose* pose = nullptr;
  for (const StampedPose& sample : trajectory) {
    if (pose == nullptr || isNearer(sample.stamp, pose->stamp)) pose = &sample;
  }
  if (pose == nullptr || secondsFromStamp(std::abs(pose->stamp - stamp)) > kNearStamp_s) {
    throw InputError("the trajectory has no pose within a second of " + formatFixed(secondsFromStamp(stamp), 3) + " s");
  }
  KeyframeId nearest(0);
  for (const KeyframeId id : map.keyframes().ids()) {
    if (isNearer(map.keyframes()[id].stamp, map.keyframes()[nearest].stamp)) nearest = id;
  }
  return {nearest, map.T_map_keyframe(nearest).inverse() * pose->T_world_base};
}

PoseCov covOf(const RequestedClosure& closure) {
  if (!closure.cov.isZero(0.0)) return symmetric(inFixedAxes(closure.T_match_query.inverse(), closure.cov));
  PoseCov cov = PoseCov::Zero();
  cov.diagonal().head<3>().setConstant(kStddev_m * kStddev_m);
  cov.diagonal().tail<3>().setConstant(kStddev_rad * kStddev_rad);
  return cov;
}

void requireUsable(const RequestedClosure& closure) {
  if (!closure.T_match_query.isValid() || closure.T_match_query.translation_m.cwiseAbs().maxCoeff() > kFarthest_m) {
    throw InputError("the transform of a closure is not finite, beyond 1e7 m, or its quaternion has no unit norm");
  }
  if (!closure.cov.allFinite() || (!closure.cov.isZero(0.0) && !choleskyOf(closure.cov))) {
    throw InputError("the covariance of a closure is not positive definite; all zero means not known");
  }
  if (closure.cov.isZero(0.0)) return;
  const FixedAxesCov information = inverted(closure.cov);
  if (!(information.array().abs() <= kMostInformation).all() ||
      closure.cov.diagonal().maxCoeff() > kFarthest_m * kFarthest_m) {
    throw InputError("the standard deviations of a closure are below 1e-6 or beyond 1e7 m or rad");
  }
}

}  // namespace

MixtureLandmark Slam::requireLandmark(LandmarkId name) {
  endSubmap();
  const auto found = parts_.map.find(name);
  if (!found) failNoLandmark(name);
  return inMap(parts_.map, parts_.graph, found->first, found->second);
}

void Slam::removeLandmark(LandmarkId name) {
  const MixtureLandmark landmark = requireLandmark(name);
  if (landmark.is_locked) throw InputError("landmark " + std::to_string(name) + " is locked");
  const double radius_m = radiusOfRemoval(landmark, landmarksOf(*this), fitted_.back_end.revisit.pair_distance_m);
  parts_.map.removeLandmark(landmark.id, landmark.position.mean_m, radius_m);
}

void Slam::bringBackLandmark(LandmarkId name) {
  if (!parts_.map.bringBackLandmark(name)) {
    throw InputError("landmark " + std::to_string(name) + " was not removed");
  }
}

void Slam::lockLandmark(LandmarkId name) {
  parts_.map.lockLandmark(requireLandmark(name));
}

void Slam::unlockLandmark(LandmarkId name) {
  if (!parts_.map.unlockLandmark(name)) throw InputError("landmark " + std::to_string(name) + " is not locked");
}

ClosureId Slam::addClosure(const RequestedClosure& closure) {
  requireUsable(closure);
  endSubmap();
  Map& map = parts_.map;
  if (map.keyframes().empty()) throw InputError("there is no map yet that a closure could tie together");
  const std::vector<StampedPose> trajectory = trajectoryOf(*this);
  const TiedPose query = tiedPoseAt(closure.query, true, trajectory, map);
  const TiedPose match = tiedPoseAt(closure.match, false, trajectory, map);
  if (query.keyframe <= match.keyframe) {
    throw InputError("both poses of a closure hang on one keyframe, or the one to match is the later one");
  }
  LoopClosureRecord record;
  record.source = ClosureSource::kRequest;
  record.query_keyframe = query.keyframe;
  record.match_keyframe = match.keyframe;
  record.is_verified = true;
  record.T_match_query = match.T_keyframe_base * closure.T_match_query * query.T_keyframe_base.inverse();
  const PoseCov cov = inFixedAxes(query.T_keyframe_base, covOf(closure));
  record.cov = carried(cov, -query.T_keyframe_base.translation_m);
  const ClosureId id = map.add(std::move(record));
  settleRequest();
  map.addPairs(id, landmarksSeenAgain(map, parts_.graph, classes_, map.closures()[id], recentSubmaps(fitted_),
                                      fitted_.back_end.revisit.pair_distance_m));
  settleRequest();
  return id;
}

void Slam::removeClosure(ClosureId closure) {
  endSubmap();
  const auto& closures = parts_.map.closures();
  const std::string name = "closure " + (closure.isNone() ? "-" : std::to_string(closure.index()));
  if (!closures.has(closure)) throw InputError("there is no " + name);
  if (!closures[closure].is_accepted) throw InputError(name + " does not hold: " + closures[closure].reason);
  parts_.graph.removeClosure(closure);
  settleRequest();
}

/// Solves everything: a person waits for it, and may have moved all of the map.
void Slam::settleRequest() {
  parts_.graph.settle(parts_.map, true);
  tieToNewestKeyframe(parts_);
}

}  // namespace semantic_mht_slam
