#include "semantic_mht_slam/slam/revisit_search.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "semantic_mht_slam/common/gaussian.h"

namespace semantic_mht_slam {
namespace {

/// Mean of what several keyframes say of a landmark.
struct EarlierLandmark {
  RegistrationPoint point;
  int sightings = 0;
};

RegistrationPoint moved(const Pose& T_a_b, const SceneObject& object) {
  const Eigen::Matrix3d R = T_a_b.rotation.toRotationMatrix();
  return {T_a_b * object.position_m, symmetric(R * object.cov_m2 * R.transpose()), object.class_index};
}

/// What one earlier drive past a place saw there. Each pass has only its own, local odometry error in it, whatever the
/// drift between passes.
struct Pass {
  std::vector<KeyframeId> keyframes;
  std::vector<LandmarkId> ids;
  std::vector<RegistrationPoint> points;
};

/// Runs of successive keyframes among the first `end` that are near a position.
std::vector<std::vector<KeyframeId>> runsWithin(double radius_m, const Eigen::Vector3d& position_m, const Map& map,
                                                KeyframeId end) {
  std::vector<std::vector<KeyframeId>> runs;
  KeyframeId next;  // of the run
  for (KeyframeId k(0); k < end; ++k) {
    const Eigen::Vector3d offset = map.T_map_keyframe(k).translation_m - position_m;
    if (offset.head<2>().norm() > radius_m) continue;
    if (k != next) runs.emplace_back();
    runs.back().push_back(k);
    next = k;
    ++next;
  }
  return runs;
}

/// The same near the pose that is expected.
std::vector<std::vector<KeyframeId>> runsNear(const Map& map, KeyframeId end, const RegistrationPrior& prior,
                                              const RevisitConfig& config) {
  const double radius_m = 0.5 * config.range_m + 3.0 * prior.stddev_xy_m;
  return runsWithin(radius_m, prior.T_a_b.translation_m, map, end);
}

Pass makePass(const Map& map, const std::vector<KeyframeId>& keyframes) {
  std::map<LandmarkId, EarlierLandmark> landmarks;
  for (const KeyframeId keyframe : keyframes) {
    for (const SceneObject& object : map.keyframes()[keyframe].scene.objects) {
      const RegistrationPoint point = moved(map.T_map_keyframe(keyframe), object);
      EarlierLandmark& landmark = landmarks[object.landmark];
      if (++landmark.sightings == 1) {
        landmark.point = point;
      } else {
        landmark.point.position_m += (point.position_m - landmark.point.position_m) / landmark.sightings;
      }
    }
  }
  Pass pass;
  pass.keyframes = keyframes;
  for (const auto& [id, landmark] : landmarks) {
    pass.ids.push_back(id);
    pass.points.push_back(landmark.point);
  }
  return pass;
}

KeyframeId nearestKeyframe(const Map& map, const std::vector<KeyframeId>& keyframes,
                           const Eigen::Vector3d& position_m) {
  const auto distance = [&](KeyframeId k) { return (map.T_map_keyframe(k).translation_m - position_m).squaredNorm(); };
  return *std::min_element(keyframes.begin(), keyframes.end(),
                           [&](KeyframeId a, KeyframeId b) { return distance(a) < distance(b); });
}

/// One record of laying a scene onto a pass; empty if nothing fits.
std::optional<LoopClosureRecord> layOnto(const Map& map, const std::vector<KeyframeId>& run, const Scene& scene,
                                         const RegistrationPrior& prior, const ClassTable& classes,
                                         const RegistrationConfig& registration, const RevisitConfig& config) {
  const std::vector<RegistrationPoint> seen = registrationPoints(scene);
  const Pass pass = makePass(map, run);
  const auto modes = align(pass.points, seen, prior, classes, registration);
  if (modes.empty()) return std::nullopt;
  const RegistrationMode& best = modes.front();
  LoopClosureRecord record;
  record.match_keyframe = nearestKeyframe(map, pass.keyframes, best.T_a_b.translation_m);
  record.T_match_query = map.T_map_keyframe(record.match_keyframe).inverse() * best.T_a_b;
  record.cov = best.cov;
  record.score = best.log_evidence;
  for (const RegisteredPair& pair : best.pairs) {
    const std::size_t in_scene = pair.b;
    const std::size_t in_pass = pair.a;
    const Eigen::Vector3d apart_m = best.T_a_b * seen[in_scene].position_m - pass.points[in_pass].position_m;
    if (apart_m.head<2>().norm() > config.pair_distance_m) continue;
    ++record.inliers;
    record.pairs.push_back({scene.objects[in_scene].landmark, pass.ids[in_pass]});
  }
  if (best.log_evidence < config.min_log_evidence) {
    record.reason = "too little evidence";
  } else if (modes.size() > 1 && best.log_evidence - modes[1].log_evidence < config.min_log_margin) {
    record.reason = "ambiguous";
  }
  record.is_verified = record.reason.empty();
  return record;
}

}  // namespace

void describe(RevisitConfig& config, Fields& fields) {
  fields.add("enabled", config.enabled,
             "Whether the surroundings are laid onto the earlier map near the present pose.");
  fields.add("min_driven", config.min_driven_m, "m", {1.0, 1e6}, "The earlier map is what was seen this far back.");
  fields.add("range", config.range_m, "m", {1.0, 1000.0}, "Keyframes within half of this, and the drift, are used.");
  fields.add("base_stddev", config.base_stddev_m, "m", {0.01, 100.0}, "Deviation of the prior right after a closure,");
  fields.add("base_stddev_rad", config.base_stddev_rad, "rad", {1e-4, 3.0}, "and of its heading.");
  fields.add("max_stddev", config.max_stddev_m, "m", {0.1, 1000.0},
             "The deviation, which grows with the odometry's errors, stays below this.");
  fields.add("min_log_evidence", config.min_log_evidence, "nats", {0.0, 1e6},
             "Least evidence of an accepted alignment against \"not here before\".");
  fields.add("min_log_margin", config.min_log_margin, "nats", {0.0, 1e6},
             "Least evidence over the second best alignment.");
  fields.add("pair_distance", config.pair_distance_m, "m", {0.01, 100.0},
             "Landmarks that an alignment pairs are one if they stand no further apart after it.");
}

std::size_t passesAt(const Map& map, const Eigen::Vector3d& position_m, double radius_m) {
  return runsWithin(radius_m, position_m, map, map.keyframes().nextId()).size();
}

Scene sceneAround(const Map& map, KeyframeId centre, const RevisitConfig& config) {
  const Eigen::Vector3d& centre_m = map.T_map_keyframe(centre).translation_m;
  std::vector<KeyframeId> pass;
  for (std::vector<KeyframeId>& run : runsWithin(0.5 * config.range_m, centre_m, map, map.keyframes().nextId())) {
    if (run.front() <= centre && centre <= run.back()) pass = std::move(run);
  }
  const Pose T_centre_map = map.T_map_keyframe(centre).inverse();
  Pass seen = makePass(map, pass);
  Scene scene;
  for (std::size_t i = 0; i < seen.points.size(); ++i) {
    const RegistrationPoint& point = seen.points[i];
    const Eigen::Matrix3d R = T_centre_map.rotation.toRotationMatrix();
    SceneObject object;
    object.position_m = T_centre_map * point.position_m;
    object.cov_m2 = symmetric(R * point.cov_m2 * R.transpose());
    object.class_index = point.class_index;
    object.landmark = seen.ids[i];
    scene.objects.push_back(object);
  }
  return scene;
}

std::vector<LoopClosureRecord> findInMap(const Map& map, const Scene& scene, const RegistrationPrior& prior,
                                         const ClassTable& classes, const RegistrationConfig& registration,
                                         const RevisitConfig& config) {
  std::vector<LoopClosureRecord> records;
  for (const std::vector<KeyframeId>& run : runsNear(map, map.keyframes().nextId(), prior, config)) {
    if (auto record = layOnto(map, run, scene, prior, classes, registration, config))
      records.push_back(std::move(*record));
  }
  return records;
}

std::vector<LoopClosureRecord> findRevisits(const Map& map, KeyframeId query, const RegistrationPrior& prior,
                                            const ClassTable& classes, const RegistrationConfig& registration,
                                            const RevisitConfig& config) {
  const Keyframe& asked = map.keyframes()[query];
  KeyframeId end(0);
  while (end < query && map.keyframes()[end].driven_m <= asked.driven_m - config.min_driven_m) ++end;
  std::vector<LoopClosureRecord> records;
  for (const std::vector<KeyframeId>& run : runsNear(map, end, prior, config)) {
    auto record = layOnto(map, run, asked.scene, prior, classes, registration, config);
    if (!record) continue;
    record->query_keyframe = query;
    records.push_back(std::move(*record));
  }
  return records;
}

}  // namespace semantic_mht_slam
