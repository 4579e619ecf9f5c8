#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/slam/map_delta.h"
#include "semantic_mht_slam/slam/slam_parts_state.h"

namespace semantic_mht_slam {
namespace {

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
    std::set<LandmarkId> second_names;
    for (const SameLandmark& pair : delta.duplicates) second_names.insert(pair.first);
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      show(delta.keyframes[k].landmarks, second_names, keyframes[k], submap);
    }
    if (delta.begins_session) parts_.sessions.begin(parts_.map.keyframes().nextId());
    for (const Keyframe& keyframe : keyframes) {
      const std::optional<StampedPose> newest = parts_.sessions.latestOdometry();
      if (newest && keyframe.stamp <= newest->stamp) continue;  // maps of bare landmarks have no time
      parts_.sessions.add(StampedPose{keyframe.stamp, keyframe.T_odom_base});
    }
    const auto ids = parts_.map.add(std::make_shared<const Submap>(std::move(submap)), std::move(keyframes));
    try {
      parts_.graph.add(parts_.map, ids, sightingsOf(delta), odometry);
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

  /// The parts of an estimator; the one that would map on has learned nothing.
  SlamParts finish() {
    parts_.graph.settle(parts_.map, true);
    parts_.driven = motionTo(parts_.map.keyframes().back());
    if (parts_.mapper) parts_.mapper->goOnAfter(parts_.map.submaps().back()->id, parts_.map.newestName());
    return std::move(parts_);
  }

 private:
  Keyframe keyframeOf(const DeltaKeyframe& seen, SubmapId submap) {
    if (!(seen.driven.way_m >= driven_m_ && std::isfinite(seen.driven.way_m)))
      throw InputError("keyframes that are not in the order of the drive");
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
      if (!known.position.mean_m.allFinite() || !isCovariance(known.position.cov_m2)) {
        throw InputError("a landmark whose covariance is not positive definite");
      }
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
  void show(const std::vector<std::size_t>& landmarks, const std::set<LandmarkId>& second_names, Keyframe& keyframe,
            Submap& submap) const {
    const Pose T_keyframe_submap = keyframe.T_odom_base.inverse() * submap.T_odom_submap;
    int row = 0;
    std::size_t next = 0;
    for (const std::size_t place : landmarks) {
      if (place < next || place >= submap.landmarks.size()) {
        throw InputError("a keyframe that shows no landmark, or one twice");
      }
      next = place + 1;
      const MixtureLandmark& landmark = submap.landmarks[place];
      keyframe.scene.objects.push_back(sceneObject(landmark, T_keyframe_submap, floor_m_));
      if (second_names.count(landmark.id) == 0) submap.associations.push_back({keyframe.frame, row++, landmark.id});
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

SlamConfig fittedTo(const SlamConfig& config, const MapByDeltas& map) {
  return map.range_factor == 1.0 ? config : fittedTo(config, map.range_factor);
}

SlamParts rebuilt(const MapByDeltas& map, const SlamConfig& fitted, const ClassTable& classes) {
  if (map.deltas.empty()) throw InputError("has no finished submap");
  Rebuilding rebuilding(fitted, classes, map.range_factor);
  for (const MapDelta& delta : map.deltas) rebuilding.add(delta, map.held, map.deltas.back().odometry);
  return rebuilding.finish();
}

}  // namespace

SlamParts makeMap(const MapByDeltas& map, const SlamConfig& config, const ClassTable& classes) {
  SlamParts parts = rebuilt(map, fittedTo(config, map), classes);
  parts.mapper.reset();
  return parts;
}

SlamState makeState(const MapByDeltas& map, const SlamConfig& config, const ClassTable& classes) {
  const SlamConfig fitted = fittedTo(config, map);
  SlamParts parts = rebuilt(map, fitted, classes);
  if (parts.closer) {
    for (const SubmapId id : parts.map.submaps().ids()) parts.closer->takeIn(parts.map, id);
  }
  return stateOf(fitted, parts);
}

}  // namespace semantic_mht_slam
