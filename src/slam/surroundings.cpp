#include "semantic_mht_slam/slam/surroundings.h"

#include <algorithm>
#include <utility>

namespace semantic_mht_slam {
namespace {

constexpr double kGraphShift = 1.0 / 6.0;  // of the reach: as far as the graph may move a landmark in its submap

}  // namespace

MixtureLandmark inMap(const Map& map, const MapGraph& graph, SubmapId submap, const MixtureLandmark& seen) {
  MixtureLandmark landmark = transformed(map.T_map_submap(submap), seen);
  if (landmark.is_locked) return landmark;
  const std::optional<Eigen::Vector3d> position_m = graph.landmark(landmark.id);
  if (!position_m) return landmark;
  const Eigen::Vector3d shift_m = *position_m - landmark.position.mean_m;
  landmark.position.mean_m += shift_m;
  for (MixtureComponent& component : landmark.components) component.position.mean_m += shift_m;
  return landmark;
}

void addPoseShare(const FixedAxesCov& pose_cov, const Eigen::Vector3d& lever_m, double floor_m,
                  MixtureLandmark& landmark) {
  Eigen::Matrix3d share = carried(pose_cov, lever_m).topLeftCorner<3, 3>();
  share.diagonal().array() += floor_m * floor_m;
  for (MixtureComponent& component : landmark.components) component.position.cov_m2 += share;
  landmark.position.cov_m2 += share;
}

std::vector<MixtureLandmark> landmarksOf(const Map& map, const MapGraph& graph, const MapUncertainty& uncertainty) {
  std::vector<MixtureLandmark> landmarks;
  map.forEachLandmark([&](SubmapId submap, const MixtureLandmark& seen) {
    MixtureLandmark& landmark = landmarks.emplace_back(inMap(map, graph, submap, seen));
    const KeyframeId from = map.keyframesOf(submap).front();
    const Eigen::Vector3d lever_m = landmark.position.mean_m - map.T_map_keyframe(from).translation_m;
    addPoseShare(uncertainty.keyframes[from], lever_m, graph.sightingFloor_m(), landmark);
    const auto known = uncertainty.landmarks.find(graph.keptName(landmark.id));
    if (known == uncertainty.landmarks.end() || landmark.is_locked) return;
    landmark.position.cov_m2 = known->second;
    if (landmark.components.size() == 1) landmark.components.front().position.cov_m2 = known->second;
  });
  return landmarks;
}

std::vector<MixtureLandmark> landmarksBeyond(const Map& map, const std::vector<MixtureLandmark>& seen,
                                             const Pose& T_map_submap) {
  std::vector<MixtureLandmark> landmarks;
  for (const MixtureLandmark& landmark : seen) {
    if (landmark.existence_prob < map.keepProb() || map.hasLandmark(landmark.id)) continue;
    MixtureLandmark in_map = transformed(T_map_submap, landmark);
    if (map.isRemoved({in_map.id}, in_map.mostLikelyClass(), in_map.position.mean_m)) continue;
    landmarks.push_back(std::move(in_map));
  }
  return landmarks;
}

EarlierMap earlierMapAround(const RegistrationPrior& prior, const Map& map, const MapGraph& graph,
                            std::size_t recent_submaps, double reach_m) {
  EarlierMap earlier;
  earlier.stddev_xy_m = prior.stddev_xy_m;
  earlier.stddev_z_m = prior.stddev_z_m;
  earlier.stddev_yaw_rad = prior.stddev_yaw_rad;
  const Pose T_submap_map = prior.T_a_b.inverse();
  const double shift_m = kGraphShift * reach_m;
  const double radius_m = reach_m + 3.0 * prior.stddev_xy_m;
  const auto isWithin = [&](const Eigen::Vector3d& position_m, double distance_m) {
    return (position_m - prior.T_a_b.translation_m).head<2>().norm() <= distance_m;
  };
  for (const SubmapId submap : map.submaps().ids()) {
    const Pose& T_map_seen = map.T_map_submap(submap);
    if (!isWithin(T_map_seen.translation_m, radius_m + shift_m + map.reach_m(submap))) continue;
    if (submap.index() + recent_submaps >= map.submaps().size()) break;
    map.forEachLandmarkOf(submap, [&](LandmarkId name, const MixtureLandmark& seen) {
      if (!isWithin(T_map_seen * seen.position.mean_m, radius_m + shift_m)) return;
      MixtureLandmark landmark = inMap(map, graph, submap, seen);
      if (!isWithin(landmark.position.mean_m, radius_m)) return;
      landmark.id = name;
      earlier.landmarks.push_back(transformed(T_submap_map, landmark));
    });
  }
  return earlier;
}

bool isPlaceKnown(const Map& map, std::size_t passes, double radius_m) {
  if (passes == 0 || map.submaps().empty()) return false;
  const SubmapId newest(map.submaps().size() - 1);
  const IdRange<KeyframeId> keyframes = map.keyframesOf(newest);
  const auto ties = [&](const LoopClosureRecord& closure) {
    return closure.is_accepted && closure.query_keyframe >= keyframes.front();
  };
  if (std::none_of(map.closures().begin(), map.closures().end(), ties)) return false;
  for (const KeyframeId keyframe : keyframes) {
    if (passesAt(map, map.T_map_keyframe(keyframe).translation_m, radius_m) < passes) return false;
  }
  return true;
}

}  // namespace semantic_mht_slam
