#include "semantic_mht_slam/merging/map_delta.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

namespace semantic_mht_slam {
namespace {

/// A landmark as one keyframe saw it, base frame of the keyframe.
struct SeenAt {
  std::size_t keyframe = 0;
  Gaussian3 position;
};

/// What the keyframes of a submap saw of each of its landmarks: as the pose graph has it where it has it, else as in
/// their scenes.
std::map<LandmarkId, std::vector<SeenAt>> seenIn(const SlamParts& parts, SubmapId submap) {
  std::map<LandmarkId, std::vector<SeenAt>> in_graph;
  std::map<LandmarkId, std::vector<SeenAt>> seen;
  std::size_t place = 0;
  for (const KeyframeId k : parts.map.keyframesOf(submap)) {
    for (const SceneObject& object : parts.map.keyframes()[k].scene.objects) {
      std::vector<SeenAt>& one = seen[object.landmark];  // a scene shows one place of the submap, however often
      const SeenAt at{place, {object.position_m, object.cov_m2}};
      if (one.empty() || at.position.mean_m.norm() < one.front().position.mean_m.norm()) one = {at};
    }
    for (const LandmarkSighting& sighting : parts.graph.node(k).sightings) {
      in_graph[static_cast<LandmarkId>(sighting.landmark)].push_back({place, {sighting.position_m, sighting.cov_m2}});
    }
    ++place;
  }
  for (auto& [id, sightings] : seen) {
    const auto better = in_graph.find(id);
    if (better != in_graph.end()) sightings = std::move(better->second);
  }
  return seen;
}

/// A step of an odometry that is expected to have been `expected`.
Pose stepFor(const OdometryModel& odometry, const Pose& expected) {
  constexpr int kRounds = 4;  // each takes two digits or more: systematic errors are per cents
  Pose step = expected;
  for (int round = 0; round < kRounds; ++round) {
    step = step * (expectedStep(odometry, step).inverse() * expected);
  }
  return step;
}

/// The odometry between the keyframes of a submap, smoothed by what they saw: of the submap alone, whatever was closed
/// around it, so that it can be laid into another graph.
std::vector<Pose> smoothedSteps(const std::vector<PoseNode>& nodes, const OdometryModel& odometry) {
  PoseGraph graph;
  for (const PoseNode& node : nodes) graph.addNode(node);
  const bool is_solved = graph.optimizeFully().failure.empty();
  std::vector<Pose> steps;
  for (int i = 1; i < graph.nodes(); ++i) {
    const Pose expected = is_solved ? graph.pose(i - 1).inverse() * graph.pose(i) : nodes[i].T_previous_node;
    steps.push_back(stepFor(odometry, expected));
  }
  return steps;
}

/// Of the later one of two keyframes in the frame of the earlier one, or the other way round.
Pose between(std::size_t to, std::size_t from, const std::vector<DeltaKeyframe>& keyframes) {
  if (to > from) return between(from, to, keyframes).inverse();
  Pose T_to_from;
  for (std::size_t k = to + 1; k <= from; ++k) T_to_from = T_to_from * keyframes[k].T_previous_keyframe;
  return T_to_from;
}

/// All that was seen of a landmark, in the frame of the keyframe that saw it best.
SeenAt fused(const std::vector<SeenAt>& seen, const std::vector<DeltaKeyframe>& keyframes) {
  const SeenAt& best = *std::min_element(seen.begin(), seen.end(), [](const SeenAt& a, const SeenAt& b) {
    return a.position.cov_m2.trace() < b.position.cov_m2.trace();
  });
  const std::size_t keyframe = std::min(best.keyframe, kNamedKeyframes - 1);
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  for (const SeenAt& one : seen) {
    const Pose T_keyframe_one = between(keyframe, one.keyframe, keyframes);
    const Eigen::Matrix3d R = T_keyframe_one.rotation.toRotationMatrix();
    const Eigen::Matrix3d of_one = R * inverted(one.position.cov_m2) * R.transpose();
    information += of_one;
    weighted += of_one * (T_keyframe_one * one.position.mean_m);
  }
  const Eigen::Matrix3d cov_m2 = symmetric(inverted(information));
  return {keyframe, {cov_m2 * weighted, cov_m2}};
}

/// The step that leads to a keyframe from the one before by odometry, as it came; to the first one, its pose.
Pose rawStep(const Map& map, KeyframeId keyframe) {
  const Pose& T_odom_keyframe = map.keyframes()[keyframe].T_odom_base;
  if (keyframe == KeyframeId(0)) return T_odom_keyframe;
  return map.keyframes()[KeyframeId(keyframe.index() - 1)].T_odom_base.inverse() * T_odom_keyframe;
}

/// Lays the deltas behind each other.
class Rebuilding {
 public:
  Rebuilding(const SlamConfig& fitted, const ClassTable& classes, double range_factor)
      : classes_(classes), floor_m_(fitted.back_end.keyframe.sighting_floor_m), parts_(makeParts(fitted, classes)) {
    parts_.range_factor = range_factor;
    parts_.is_fitted = true;
    fitParts(fitted, classes, parts_);
  }

  /// `odometry`: what is known of it by now.
  void add(const MapDelta& delta, const std::vector<bool>& held, const OdometryModel& odometry) {
    if (delta.keyframes.empty()) throw InputError("a submap without a keyframe");
    if (delta.begins_session) {
      parts_.graph.settle(parts_.map);
      parts_.graph.goOnAt(parts_.graph.T_map_odom(parts_.map));
    }
    const SubmapId id = parts_.map.submaps().nextId();
    std::vector<Keyframe> keyframes;
    for (const DeltaKeyframe& seen : delta.keyframes) keyframes.push_back(keyframeOf(seen, id));
    Submap submap = submapOf(delta, keyframes);
    for (std::size_t k = 0; k < keyframes.size(); ++k) show(delta.keyframes[k].landmarks, delta, keyframes[k], submap);
    const auto ids = parts_.map.add(std::make_shared<const Submap>(std::move(submap)), std::move(keyframes));
    parts_.graph.add(parts_.map, ids, sightingsOf(delta), odometry);
    for (LoopClosureRecord closure : delta.closures) {
      const bool is_known =
          parts_.map.keyframes().has(closure.query_keyframe) && parts_.map.keyframes().has(closure.match_keyframe);
      if (!is_known) throw InputError("a closure of keyframes that there are not");
      closure.is_verified = next_closure_ < held.size() && held[next_closure_];
      closure.is_accepted = false;
      ++next_closure_;
      parts_.map.add(std::move(closure));
    }
    parts_.odometry = odometry;
  }

  SlamParts finish() {
    parts_.graph.settle(parts_.map, true);
    parts_.driven = motionTo(parts_.map.keyframes().back());
    parts_.mapper.reset();  // it has learned nothing
    return std::move(parts_);
  }

 private:
  Keyframe keyframeOf(const DeltaKeyframe& seen, SubmapId submap) {
    if (seen.driven.way_m < driven_m_) throw InputError("keyframes that are not in the order of the drive");
    driven_m_ = seen.driven.way_m;
    T_odom_newest_ = T_odom_newest_ * seen.T_previous_keyframe;
    return {frames_++, submap, seen.driven.way_m, {}, seen.stamp, T_odom_newest_, seen.driven.turn_rad};
  }

  Submap submapOf(const MapDelta& delta, const std::vector<Keyframe>& keyframes) const {
    Submap submap;
    submap.id = keyframes.front().submap;
    submap.begin = keyframes.front().stamp;
    submap.end = std::max(delta.end, keyframes.back().stamp);
    submap.T_odom_submap = keyframes.front().T_odom_base;
    submap.duplicates = delta.duplicates;
    for (std::size_t i = 0; i < delta.landmarks.size(); ++i) {
      const DeltaLandmark& known = delta.landmarks[i];
      if (i > 0 && known.id <= delta.landmarks[i - 1].id) throw InputError("landmarks whose ids do not rise");
      MixtureLandmark landmark;
      landmark.id = known.id;
      landmark.position = placeOf(known, keyframes);
      landmark.components.push_back({1.0, landmark.position});
      const int classes = classes_.size();
      const double rest = classes > 1 ? (1.0 - known.class_prob) / (classes - 1) : 0.0;
      landmark.class_probs = ClassProbs::Constant(classes, rest);
      landmark.class_probs(known.class_index) = classes > 1 ? known.class_prob : 1.0;
      landmark.existence_prob = known.existence_prob;
      landmark.observations = known.observations;
      landmark.first_submap = landmark.last_submap = submap.id;
      submap.landmarks.push_back(std::move(landmark));
    }
    return submap;
  }

  /// In the frame of the submap.
  static Gaussian3 placeOf(const DeltaLandmark& landmark, const std::vector<Keyframe>& keyframes) {
    if (landmark.keyframe >= keyframes.size()) throw InputError("a landmark that no keyframe saw");
    const Pose T_submap_base = keyframes.front().T_odom_base.inverse() * keyframes[landmark.keyframe].T_odom_base;
    const Eigen::Matrix3d R = T_submap_base.rotation.toRotationMatrix();
    return {T_submap_base * landmark.position.mean_m, symmetric(R * landmark.position.cov_m2 * R.transpose())};
  }

  static std::vector<std::vector<Sighting>> sightingsOf(const MapDelta& delta) {
    std::vector<std::vector<Sighting>> sightings(delta.keyframes.size());
    for (const DeltaLandmark& landmark : delta.landmarks) {
      const Gaussian3& position = landmark.position;
      sightings[landmark.keyframe].push_back({landmark.id, landmark.class_index, position.mean_m, position.cov_m2, 1});
    }
    return sightings;
  }

  /// What a keyframe shows is not one object, but for names that are known to be one.
  void show(const std::vector<std::size_t>& landmarks, const MapDelta& delta, Keyframe& keyframe,
            Submap& submap) const {
    const Pose T_keyframe_submap = keyframe.T_odom_base.inverse() * submap.T_odom_submap;
    int row = 0;
    for (const std::size_t place : landmarks) {
      if (place >= submap.landmarks.size()) throw InputError("a keyframe that shows no landmark");
      const MixtureLandmark& landmark = submap.landmarks[place];
      keyframe.scene.objects.push_back(sceneObject(landmark, T_keyframe_submap, floor_m_));
      const bool is_second = std::any_of(delta.duplicates.begin(), delta.duplicates.end(),
                                         [&](const SameLandmark& pair) { return pair.first == landmark.id; });
      if (!is_second) submap.associations.push_back({keyframe.frame, row++, landmark.id});
    }
  }

  const ClassTable& classes_;
  const double floor_m_;
  SlamParts parts_;
  std::size_t frames_ = 0;
  std::size_t next_closure_ = 0;
  double driven_m_ = 0.0;
  Pose T_odom_newest_;
};

}  // namespace

MapDelta deltaOf(const SlamParts& parts, SubmapId submap) {
  const Submap& finished = *parts.map.submaps()[submap];
  MapDelta delta;
  delta.end = finished.end;
  delta.odometry = parts.odometry;
  if (parts.mapper) delta.odometry.systematic.scale_translation.stddev = parts.mapper->scaleStddev();
  delta.duplicates = finished.duplicates;
  const std::map<LandmarkId, std::vector<SeenAt>> seen = seenIn(parts, submap);
  std::vector<PoseNode> nodes;
  for (const KeyframeId k : parts.map.keyframesOf(submap)) {
    const Keyframe& keyframe = parts.map.keyframes()[k];
    nodes.push_back(parts.graph.node(k));
    delta.keyframes.push_back({keyframe.stamp, motionTo(keyframe), {}, {}});
    for (const SceneObject& object : keyframe.scene.objects) {
      delta.keyframes.back().landmarks.push_back(std::distance(seen.begin(), seen.find(object.landmark)));
    }
  }
  const KeyframeId first = parts.map.keyframesOf(submap).front();
  delta.begins_session = parts.graph.beginsSession(first);
  delta.keyframes[0].T_previous_keyframe =
      delta.begins_session ? nodes.front().T_previous_node : rawStep(parts.map, first);
  const std::vector<Pose> steps = smoothedSteps(nodes, delta.odometry);
  for (std::size_t i = 0; i < steps.size(); ++i) delta.keyframes[i + 1].T_previous_keyframe = steps[i];
  for (const auto& [id, sightings] : seen) {
    const MixtureLandmark* landmark = findLandmark(id, finished.landmarks);
    if (landmark == nullptr) throw std::logic_error("deltaOf: a scene shows a landmark that its submap lacks");
    const ClassIndex class_index = landmark->mostLikelyClass();
    const SeenAt best = fused(sightings, delta.keyframes);
    delta.landmarks.push_back({id, class_index, landmark->class_probs(class_index), landmark->existence_prob,
                               landmark->observations, best.keyframe, best.position});
  }
  for (const LoopClosureRecord& closure : parts.map.closures()) {
    if (closure.is_verified && closure.came_after == submap) delta.closures.push_back(closure);
  }
  return delta;
}

std::vector<bool> heldClosures(const Map& map) {
  std::vector<bool> held;
  for (const LoopClosureRecord& closure : map.closures()) {
    if (closure.is_verified) held.push_back(closure.is_accepted);
  }
  return held;
}

SlamParts makeMap(const MapByDeltas& map, const SlamConfig& config, const ClassTable& classes) {
  if (map.deltas.empty()) throw InputError("has no finished submap");
  const SlamConfig fitted = map.range_factor == 1.0 ? config : fittedTo(config, map.range_factor);
  Rebuilding rebuilding(fitted, classes, map.range_factor);
  for (const MapDelta& delta : map.deltas) rebuilding.add(delta, map.held, map.deltas.back().odometry);
  return rebuilding.finish();
}

}  // namespace semantic_mht_slam
