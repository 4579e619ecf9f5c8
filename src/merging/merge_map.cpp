#include "semantic_mht_slam/merging/merge_map.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

constexpr std::size_t kFullScene = 20;  // landmarks; a camera sees so many only on a longer way

/// Mean of what several keyframes say of a landmark.
struct LandmarkMean {
  SceneObject object;
  int sightings = 0;

  void add(const SceneObject& seen) {
    if (++sightings == 1) object = seen;
    object.position_m += (seen.position_m - object.position_m) / sightings;
  }
};

SceneObject moved(const Pose& T_a_b, SceneObject object) {
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  object.position_m = T_a_b * object.position_m;
  object.cov_m2 = symmetric(R * object.cov_m2 * R.transpose());
  return object;
}

RegistrationPoint pointOf(const SceneObject& object) {
  return {object.position_m, object.cov_m2, object.class_index};
}

}  // namespace

void MergeMap::prepare(const MergeSettings& settings, double window_m, double spacing_m, int tile_landmarks,
                       int min_tile_landmarks) {
  odometry_ = parts_->odometry;
  makeWindows(settings, window_m, spacing_m);
  makeTiles(settings.classes, 4.0 * window_m, tile_landmarks, min_tile_landmarks);
  makePoints();
}

double MergeMap::driven_m(KeyframeId a, KeyframeId b) const {
  return std::abs(map().keyframes()[a].driven_m - map().keyframes()[b].driven_m);
}

/// An error of the heading acts on the way that leads from one to the other, not on all of a detour.
KeyframeDrift MergeMap::drift(KeyframeId a, KeyframeId b) const {
  const auto& [early, late] = std::minmax(a, b);
  const Motion motion = motionTo(map().keyframes()[late]) - motionTo(map().keyframes()[early]);
  const MotionVariance variance = varianceOf(odometry_, motion);
  const double apart_m = (map().T_map_keyframe(a).translation_m - map().T_map_keyframe(b).translation_m).norm();
  const double lever_m = std::min(motion.way_m, apart_m + 0.25 * motion.way_m);
  const double xy_m2 = std::max(variance.along_m2, variance.across_m2) + variance.heading_rad2 * lever_m * lever_m;
  return {std::sqrt(xy_m2), std::sqrt(variance.heading_rad2)};
}

KeyframeId MergeMap::nearestKeyframe(const Eigen::Vector3d& position_m) const {
  KeyframeId nearest;
  double nearest_sq = 0.0;
  for (const KeyframeId k : map().keyframes().ids()) {
    const double distance_sq = (map().T_map_keyframe(k).translation_m - position_m).head<2>().squaredNorm();
    if (nearest.isNone() || distance_sq < nearest_sq) {
      nearest = k;
      nearest_sq = distance_sq;
    }
  }
  return nearest;
}

/// Keyframes driven through at most `reach_m` before or behind one.
std::vector<KeyframeId> MergeMap::around(KeyframeId keyframe, double reach_m) const {
  std::vector<KeyframeId> result;
  std::size_t first = keyframe.index();
  while (first > 0 && driven_m(KeyframeId(first - 1), keyframe) <= reach_m) --first;
  for (const KeyframeId k : map().keyframes().idsFrom(KeyframeId(first))) {
    if (k > keyframe && driven_m(k, keyframe) > reach_m) break;
    result.push_back(k);
  }
  return result;
}

Scene MergeMap::sceneAround(KeyframeId keyframe, double reach_m) const {
  const Pose T_keyframe_map = map().T_map_keyframe(keyframe).inverse();
  std::map<LandmarkId, LandmarkMean> means;
  for (const KeyframeId k : around(keyframe, reach_m)) {
    const Pose T_keyframe_k = T_keyframe_map * map().T_map_keyframe(k);
    for (const SceneObject& object : map().keyframes()[k].scene.objects) {
      means[map().identity().landmarkOf(object.landmark)].add(moved(T_keyframe_k, object));
    }
  }
  Scene scene;
  for (auto& [id, mean] : means) {
    mean.object.landmark = id;
    scene.objects.push_back(mean.object);
  }
  return scene;
}

void MergeMap::makeWindows(const MergeSettings& settings, double window_m, double spacing_m) {
  windows_.clear();
  const PlaceUnits units(settings.range_factor);
  const double floor_m = units.toPlaces(settings.slam.registration).noise_floor_m;
  for (const KeyframeId k : map().keyframes().ids()) {
    if (!windows_.empty() && driven_m(windows_.back().keyframe, k) < spacing_m) continue;
    Scene scene = sceneAround(k, window_m);
    for (double reach_m = 1.5 * window_m; scene.objects.size() < kFullScene && reach_m <= 3.0 * window_m;
         reach_m += 0.5 * window_m) {
      scene = sceneAround(k, reach_m);
    }
    PairDescriptor descriptor =
        describePairs(units.toPlaces(scene), settings.classes, floor_m, settings.slam.back_end.place.descriptor);
    windows_.push_back({k, std::move(scene), std::move(descriptor)});
  }
}

void MergeMap::makeTiles(const ClassTable& classes, double reach_m, int tile_landmarks, int min_tile_landmarks) {
  const auto is_static = [](const ClassInfo& info) { return info.is_static; };
  const bool needs_static = std::any_of(classes.all().begin(), classes.all().end(), is_static);
  tiles_.clear();
  std::set<LandmarkId> claimed;
  MapTile tile;
  std::vector<KeyframeId> seen_from;  // each landmark of the tile
  const auto close = [&] {
    if (static_cast<int>(tile.points.size()) >= min_tile_landmarks) {
      tile.keyframe = seen_from[seen_from.size() / 2];
      const Pose T_keyframe_map = map().T_map_keyframe(tile.keyframe).inverse();
      Eigen::Vector3d middle_m = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < tile.points.size(); ++i) {
        const SceneObject seen{tile.points[i].position_m, tile.points[i].cov_m2, tile.points[i].class_index};
        tile.points[i] = pointOf(moved(T_keyframe_map * map().T_map_keyframe(seen_from[i]), seen));
        middle_m += tile.points[i].position_m / static_cast<double>(tile.points.size());
      }
      for (RegistrationPoint& point : tile.points) point.position_m -= middle_m;
      tile.T_keyframe_tile.translation_m = middle_m;
      tiles_.push_back(tile);
    }
    tile = MapTile();
    seen_from.clear();
  };
  for (const KeyframeId k : map().keyframes().ids()) {
    const bool is_long = !seen_from.empty() && driven_m(seen_from.front(), k) > reach_m;
    if (is_long && static_cast<int>(tile.points.size()) >= min_tile_landmarks) close();
    for (const SceneObject& object : map().keyframes()[k].scene.objects) {
      const LandmarkId id = map().identity().landmarkOf(object.landmark);
      if (needs_static && !classes[object.class_index].is_static) continue;  // it may have left
      if (!claimed.insert(id).second) continue;
      tile.points.push_back(pointOf(object));
      tile.landmarks.push_back(id);
      seen_from.push_back(k);
      if (static_cast<int>(tile.points.size()) == tile_landmarks) close();
    }
  }
  close();
}

void MergeMap::makePoints() {
  std::map<LandmarkId, LandmarkMean> means;
  for (const KeyframeId k : map().keyframes().ids()) {
    for (const SceneObject& object : map().keyframes()[k].scene.objects) {
      means[map().identity().landmarkOf(object.landmark)].add(moved(map().T_map_keyframe(k), object));
    }
  }
  points_.clear();
  point_ids_.clear();
  for (const auto& [id, mean] : means) {
    points_.push_back(pointOf(mean.object));
    point_ids_.push_back(id);
  }
}

}  // namespace semantic_mht_slam
