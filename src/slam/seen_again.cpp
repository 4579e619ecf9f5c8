#include "semantic_mht_slam/slam/seen_again.h"

#include <algorithm>

#include <Eigen/Cholesky>

#include "semantic_mht_slam/slam/surroundings.h"

namespace semantic_mht_slam {
namespace {

constexpr double kGateMahalanobisSq = 11.34;  // 99 % in three dimensions

struct Passes {
  std::vector<MixtureLandmark> present;  ///< first seen by the present pass, map frame
  std::vector<MixtureLandmark> earlier;  ///< known before it, whether it saw them again or not
};

Passes passesOf(const Map& map, const MapGraph& graph, const ClassTable& classes, SubmapId here,
                std::size_t recent_submaps, double pair_distance_m) {
  const auto is_earlier = [&](SubmapId submap) { return submap.index() + recent_submaps <= here.index(); };
  const auto is_present = [&](SubmapId submap) {
    return !is_earlier(submap) && submap.index() < here.index() + recent_submaps;
  };
  const auto visit = [&](SubmapId submap, const auto& take) {
    map.forEachLandmarkOf(submap, [&](LandmarkId, const MixtureLandmark& seen) {
      if (classes[seen.mostLikelyClass()].is_static) take(inMap(map, graph, submap, seen));
    });
  };
  Passes passes;
  std::vector<SubmapId> earlier;
  double reach_m = 0.0;
  const Eigen::Vector3d here_m = map.T_map_submap(here).translation_m;
  for (const SubmapId submap : map.submaps().ids()) {
    if (is_earlier(submap)) earlier.push_back(submap);
    if (!is_present(submap)) continue;
    visit(submap, [&](MixtureLandmark landmark) {
      if (is_earlier(landmark.first_submap)) {
        passes.earlier.push_back(std::move(landmark));
        return;
      }
      reach_m = std::max(reach_m, (landmark.position.mean_m - here_m).norm());
      passes.present.push_back(std::move(landmark));
    });
  }
  if (passes.present.empty()) return passes;
  for (const SubmapId submap : earlier) {
    const double distance_m = (map.T_map_submap(submap).translation_m - here_m).norm();
    if (distance_m > reach_m + map.reach_m(submap) + 2.0 * pair_distance_m) continue;
    visit(submap, [&](MixtureLandmark landmark) { passes.earlier.push_back(std::move(landmark)); });
  }
  return passes;
}

/// The only one of `others` that `landmark` can be; nothing if there are none or several.
const MixtureLandmark* onlyMatch(const MixtureLandmark& landmark, const std::vector<MixtureLandmark>& others,
                                 const Eigen::Matrix3d& tie_cov_m2, double pair_distance_m) {
  const MixtureLandmark* match = nullptr;
  for (const MixtureLandmark& other : others) {
    if (other.mostLikelyClass() != landmark.mostLikelyClass()) continue;
    const Eigen::Vector3d apart_m = other.position.mean_m - landmark.position.mean_m;
    if (apart_m.head<2>().norm() > pair_distance_m) continue;
    const Eigen::Matrix3d cov_m2 = landmark.position.cov_m2 + other.position.cov_m2 + tie_cov_m2;
    if (apart_m.dot(cov_m2.llt().solve(apart_m)) > kGateMahalanobisSq) continue;
    if (match != nullptr) return nullptr;
    match = &other;
  }
  return match;
}

}  // namespace

std::vector<SameLandmark> landmarksSeenAgain(const Map& map, const MapGraph& graph, const ClassTable& classes,
                                             const LoopClosureRecord& tie, std::size_t recent_submaps,
                                             double pair_distance_m) {
  const SubmapId here = map.keyframes()[tie.query_keyframe].submap;
  const Passes passes = passesOf(map, graph, classes, here, recent_submaps, pair_distance_m);
  const Eigen::Matrix3d R = map.T_map_keyframe(tie.query_keyframe).rotation.toRotationMatrix();
  const Eigen::Matrix3d tie_cov_m2 = R * tie.cov.topLeftCorner<3, 3>() * R.transpose();
  std::vector<SameLandmark> pairs;
  for (const MixtureLandmark& landmark : passes.present) {
    const MixtureLandmark* match = onlyMatch(landmark, passes.earlier, tie_cov_m2, pair_distance_m);
    if (match == nullptr) continue;
    if (onlyMatch(*match, passes.present, tie_cov_m2, pair_distance_m) != &landmark) continue;
    pairs.push_back({landmark.id, match->id});
  }
  return pairs;
}

ClosureId newestTie(const Map& map) {
  if (map.submaps().empty()) return {};
  const KeyframeId first = map.keyframesOf(map.submaps().back()->id).front();
  ClosureId tie;
  for (const ClosureId id : map.closures().ids()) {
    const LoopClosureRecord& closure = map.closures()[id];
    if (closure.is_verified) tie = closure.query_keyframe >= first ? id : ClosureId();
  }
  return !tie.isNone() && map.closures()[tie].is_accepted ? tie : ClosureId();
}

}  // namespace semantic_mht_slam
