#include "semantic_mht_slam/slam/map_delta.h"

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
std::map<LandmarkId, std::vector<SeenAt>> seenIn(const SubmapContent& content) {
  std::map<LandmarkId, std::vector<SeenAt>> in_graph;
  std::map<LandmarkId, std::vector<SeenAt>> seen;
  for (std::size_t k = 0; k < content.keyframes.size(); ++k) {
    for (const SceneObject& object : content.keyframes[k].scene.objects) {
      if (findLandmark(object.landmark, content.submap->landmarks) == nullptr) continue;  // a file may say so
      std::vector<SeenAt>& one = seen[object.landmark];  // a scene shows one place of the submap, however often
      const SeenAt at{k, {object.position_m, object.cov_m2}};
      if (one.empty() || at.position.mean_m.norm() < one.front().position.mean_m.norm()) one = {at};
    }
    for (const LandmarkSighting& sighting : content.nodes[k].sightings) {
      in_graph[static_cast<LandmarkId>(sighting.landmark)].push_back({k, {sighting.position_m, sighting.cov_m2}});
    }
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

}  // namespace

SubmapContent contentOf(const SlamParts& parts, SubmapId submap) {
  SubmapContent content;
  content.submap = parts.map.submaps()[submap];
  for (const KeyframeId k : parts.map.keyframesOf(submap)) {
    content.keyframes.push_back(parts.map.keyframes()[k]);
    content.nodes.push_back(parts.graph.node(k));
  }
  const KeyframeId first = parts.map.keyframesOf(submap).front();
  content.T_before_first = rawStep(parts.map, first);
  content.begins_session =
      first != KeyframeId(0) && (parts.graph.beginsSession(first) || parts.sessions.beginsAt(first));
  content.odometry = parts.odometry;
  if (parts.mapper) content.odometry.systematic.scale_translation.stddev = parts.mapper->scaleStddev();
  for (const LoopClosureRecord& closure : parts.map.closures()) {
    if (closure.is_verified && closure.came_after == submap) content.closures.push_back(closure);
  }
  return content;
}

MapContent contentOf(const SlamParts& parts) {
  MapContent content;
  content.range_factor = parts.range_factor;
  for (const SubmapId id : parts.map.submaps().ids()) content.submaps.push_back(contentOf(parts, id));
  content.held = heldClosures(parts.map);
  return content;
}

MapDelta deltaOf(const SubmapContent& content) {
  MapDelta delta;
  delta.end = content.submap->end;
  delta.odometry = content.odometry;
  delta.begins_session = content.begins_session;
  delta.duplicates = content.submap->duplicates;
  delta.closures = content.closures;
  const std::map<LandmarkId, std::vector<SeenAt>> seen = seenIn(content);
  for (const Keyframe& keyframe : content.keyframes) {
    delta.keyframes.push_back({keyframe.stamp, motionTo(keyframe), {}, {}});
    for (const SceneObject& object : keyframe.scene.objects) {
      const auto known = seen.find(object.landmark);
      if (known == seen.end()) continue;
      delta.keyframes.back().landmarks.push_back(std::distance(seen.begin(), known));
    }
    std::sort(delta.keyframes.back().landmarks.begin(), delta.keyframes.back().landmarks.end());
  }
  delta.keyframes[0].T_previous_keyframe =
      content.begins_session ? content.nodes.front().T_previous_node : content.T_before_first;
  const std::vector<Pose> steps = smoothedSteps(content.nodes, content.odometry);
  for (std::size_t i = 0; i < steps.size(); ++i) delta.keyframes[i + 1].T_previous_keyframe = steps[i];
  for (const auto& [id, sightings] : seen) {
    const MixtureLandmark* landmark = findLandmark(id, content.submap->landmarks);
    const ClassIndex class_index = landmark->mostLikelyClass();
    const SeenAt best = fused(sightings, delta.keyframes);
    delta.landmarks.push_back({id, class_index, landmark->class_probs(class_index), landmark->existence_prob,
                               landmark->observations, best.keyframe, best.position});
  }
  return delta;
}

MapDelta deltaOf(const SlamParts& parts, SubmapId submap) {
  return deltaOf(contentOf(parts, submap));
}

std::vector<bool> heldClosures(const Map& map) {
  std::vector<bool> held;
  for (const LoopClosureRecord& closure : map.closures()) {
    if (closure.is_verified) held.push_back(closure.is_accepted);
  }
  return held;
}

}  // namespace semantic_mht_slam
