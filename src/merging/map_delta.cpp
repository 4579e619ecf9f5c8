#include "semantic_mht_slam/merging/map_delta.h"

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

namespace semantic_mht_slam {
namespace {

constexpr double kSameStep_m = 1e-3;

DeltaSighting sightingOf(const SceneObject& object, const PoseNode& node, std::size_t landmark) {
  DeltaSighting result{landmark, {object.position_m, object.cov_m2}};
  for (const LandmarkSighting& seen : node.sightings) {
    if (static_cast<LandmarkId>(seen.landmark) != object.landmark) continue;
    result.position = {seen.position_m, seen.cov_m2};
    break;
  }
  return result;
}

/// Correction of the odometry with which a keyframe begins, if the odometry before does not lead to it.
std::optional<Pose> begunAt(const SlamParts& parts, KeyframeId first, const OdometryModel& odometry) {
  if (first == KeyframeId(0)) return std::nullopt;
  const Keyframe& keyframe = parts.map.keyframes()[first];
  const Pose& T_odom_before = parts.map.keyframes()[KeyframeId(first.index() - 1)].T_odom_base;
  const Pose by_odometry = expectedStep(odometry, T_odom_before.inverse() * keyframe.T_odom_base);
  const Pose step = parts.graph.node(first).T_previous_node;
  const double way_m = (step.translation_m - by_odometry.translation_m).norm();
  if (way_m < kSameStep_m + 0.1 * by_odometry.translation_m.norm()) return std::nullopt;
  return parts.map.T_map_keyframe(first) * keyframe.T_odom_base.inverse();
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
    requireSound(delta);
    const SubmapId id = parts_.map.submaps().nextId();
    if (delta.T_map_odom) {
      parts_.graph.settle(parts_.map);
      parts_.graph.goOnAt(*delta.T_map_odom);
    }
    Submap submap = submapOf(delta, id);
    std::vector<Keyframe> keyframes;
    std::vector<std::vector<Sighting>> sightings;
    for (const DeltaKeyframe& seen : delta.keyframes) {
      keyframes.push_back(keyframeOf(seen, submap));
      sightings.push_back(sightingsOf(seen, delta));
      noteSideBySide(seen, delta, keyframes.back().frame, submap);
    }
    const auto ids = parts_.map.add(std::make_shared<const Submap>(std::move(submap)), std::move(keyframes));
    try {
      parts_.graph.add(parts_.map, ids, sightings, odometry);
    } catch (const std::invalid_argument& error) {  // such as odometry that covers too much ground to be of use
      throw InputError(std::string("keyframes that make no graph: ") + error.what());
    }
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
  void requireSound(const MapDelta& delta) {
    if (delta.keyframes.empty()) throw InputError("a submap without a keyframe");
    for (const DeltaKeyframe& keyframe : delta.keyframes) {
      if (keyframe.driven.way_m < driven_m_) throw InputError("keyframes that are not in the order of the drive");
      driven_m_ = keyframe.driven.way_m;
      std::set<std::size_t> landmarks;
      for (const DeltaSighting& seen : keyframe.sightings) {
        if (seen.landmark >= delta.landmarks.size()) throw InputError("a sighting of no landmark");
        if (!landmarks.insert(seen.landmark).second) throw InputError("a keyframe that sees a landmark twice");
        if (!isCovariance(seen.position.cov_m2))
          throw InputError("a sighting whose covariance is not positive definite");
      }
    }
  }

  Submap submapOf(const MapDelta& delta, SubmapId id) const {
    Submap submap;
    submap.id = id;
    submap.begin = delta.keyframes.front().stamp;
    submap.end = std::max(delta.end, delta.keyframes.back().stamp);
    submap.T_odom_submap = delta.keyframes.front().T_odom_base;
    submap.duplicates = delta.duplicates;
    std::vector<Gaussian3> places = placesOf(delta);
    for (std::size_t i = 0; i < delta.landmarks.size(); ++i) {
      const DeltaLandmark& known = delta.landmarks[i];
      if (i > 0 && known.id <= delta.landmarks[i - 1].id) throw InputError("landmarks whose ids do not rise");
      MixtureLandmark landmark;
      landmark.id = known.id;
      landmark.position = places[i];
      landmark.components.push_back({1.0, places[i]});
      const int classes = classes_.size();
      const double rest = classes > 1 ? (1.0 - known.class_prob) / (classes - 1) : 0.0;
      landmark.class_probs = ClassProbs::Constant(classes, rest);
      landmark.class_probs(known.class_index) = classes > 1 ? known.class_prob : 1.0;
      landmark.existence_prob = known.existence_prob;
      landmark.observations = known.observations;
      landmark.first_submap = landmark.last_submap = id;
      submap.landmarks.push_back(std::move(landmark));
    }
    return submap;
  }

  /// Of each landmark in the frame of the submap, as all keyframes together say.
  static std::vector<Gaussian3> placesOf(const MapDelta& delta) {
    std::vector<Eigen::Matrix3d> information(delta.landmarks.size(), Eigen::Matrix3d::Zero());
    std::vector<Eigen::Vector3d> weighted(delta.landmarks.size(), Eigen::Vector3d::Zero());
    const Pose T_submap_odom = delta.keyframes.front().T_odom_base.inverse();
    for (const DeltaKeyframe& keyframe : delta.keyframes) {
      const Pose T_submap_base = T_submap_odom * keyframe.T_odom_base;
      const Eigen::Matrix3d R = T_submap_base.rotation.toRotationMatrix();
      for (const DeltaSighting& seen : keyframe.sightings) {
        const Eigen::Matrix3d one = R * inverted(seen.position.cov_m2) * R.transpose();
        information[seen.landmark] += one;
        weighted[seen.landmark] += one * (T_submap_base * seen.position.mean_m);
      }
    }
    std::vector<Gaussian3> places;
    for (std::size_t i = 0; i < information.size(); ++i) {
      if (information[i].isZero(0.0)) throw InputError("a landmark without a sighting");
      const Eigen::Matrix3d cov_m2 = symmetric(inverted(information[i]));
      places.push_back({cov_m2 * weighted[i], cov_m2});
      if (!isCovariance(cov_m2) || !places.back().mean_m.allFinite()) {
        throw InputError("a landmark that its sightings do not place");
      }
    }
    return places;
  }

  Keyframe keyframeOf(const DeltaKeyframe& seen, const Submap& submap) {
    Keyframe keyframe;
    keyframe.frame = frames_++;
    keyframe.submap = submap.id;
    keyframe.driven_m = seen.driven.way_m;
    keyframe.turned_rad = seen.driven.turn_rad;
    keyframe.stamp = seen.stamp;
    keyframe.T_odom_base = seen.T_odom_base;
    const Pose T_keyframe_submap = seen.T_odom_base.inverse() * submap.T_odom_submap;
    for (const DeltaSighting& sighting : seen.sightings) {
      keyframe.scene.objects.push_back(sceneObject(submap.landmarks[sighting.landmark], T_keyframe_submap, floor_m_));
    }
    return keyframe;
  }

  static std::vector<Sighting> sightingsOf(const DeltaKeyframe& seen, const MapDelta& delta) {
    std::vector<Sighting> sightings;
    for (const DeltaSighting& sighting : seen.sightings) {
      const DeltaLandmark& landmark = delta.landmarks[sighting.landmark];
      sightings.push_back({landmark.id, landmark.class_index, sighting.position.mean_m, sighting.position.cov_m2, 1});
    }
    return sightings;
  }

  /// What a keyframe shows is not one object, but for names that are known to be one.
  static void noteSideBySide(const DeltaKeyframe& seen, const MapDelta& delta, std::size_t frame, Submap& submap) {
    int row = 0;
    for (const DeltaSighting& sighting : seen.sightings) {
      const LandmarkId id = delta.landmarks[sighting.landmark].id;
      const bool is_second = std::any_of(delta.duplicates.begin(), delta.duplicates.end(),
                                         [&](const SameLandmark& pair) { return pair.first == id; });
      if (!is_second) submap.associations.push_back({frame, row++, id});
    }
  }

  const ClassTable& classes_;
  const double floor_m_;
  SlamParts parts_;
  std::size_t frames_ = 0;
  std::size_t next_closure_ = 0;
  double driven_m_ = 0.0;
};

}  // namespace

MapDelta deltaOf(const SlamParts& parts, SubmapId submap) {
  const Submap& finished = *parts.map.submaps()[submap];
  MapDelta delta;
  delta.end = finished.end;
  delta.odometry = parts.odometry;
  if (parts.mapper) delta.odometry.systematic.scale_translation.stddev = parts.mapper->scaleStddev();
  delta.duplicates = finished.duplicates;
  std::map<LandmarkId, std::size_t> place;
  for (const KeyframeId k : parts.map.keyframesOf(submap)) {
    for (const SceneObject& object : parts.map.keyframes()[k].scene.objects) place[object.landmark] = 0;
  }
  for (auto& [id, index] : place) {
    index = delta.landmarks.size();
    const MixtureLandmark* landmark = findLandmark(id, finished.landmarks);
    if (landmark == nullptr) throw std::logic_error("deltaOf: a scene shows a landmark that its submap lacks");
    const ClassIndex class_index = landmark->mostLikelyClass();
    delta.landmarks.push_back(
        {id, class_index, landmark->class_probs(class_index), landmark->existence_prob, landmark->observations});
  }
  for (const KeyframeId k : parts.map.keyframesOf(submap)) {
    const Keyframe& keyframe = parts.map.keyframes()[k];
    const PoseNode node = parts.graph.node(k);
    DeltaKeyframe& seen = delta.keyframes.emplace_back();
    seen.stamp = keyframe.stamp;
    seen.driven = motionTo(keyframe);
    seen.T_odom_base = keyframe.T_odom_base;
    for (const SceneObject& object : keyframe.scene.objects) {
      seen.sightings.push_back(sightingOf(object, node, place.at(object.landmark)));
    }
  }
  delta.T_map_odom = begunAt(parts, parts.map.keyframesOf(submap).front(), parts.odometry);
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
