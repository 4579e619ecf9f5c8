#include <map>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/map_update_conversions.h"
#include "semantic_mht_slam/common/dense_solvers.h"
#include "semantic_mht_slam/common/digest.h"

#include "map_update_codes.h"

namespace semantic_mht_slam {
namespace {

constexpr double kLandmarkStep_m = 0.01;  // of a detector that sees as far as the reference
constexpr double kLeastKeyframeStep_m = 1e-6;
constexpr std::size_t kMostPairs = 65536;  // places that a uint16 has

template <class Array>
void write(const Eigen::Vector3d& vector, Array& to) {
  using Number = typename Array::value_type;
  for (std::size_t i = 0; i < 3; ++i) to[i] = static_cast<Number>(vector[static_cast<Eigen::Index>(i)]);
}

std::uint8_t inParts(double prob) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(prob, 0.0, 1.0)));
}

std::vector<std::uint8_t> packed(const std::vector<bool>& values) {
  std::vector<std::uint8_t> bytes((values.size() + 7) / 8);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i]) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 1U << (i % 8));
  }
  return bytes;
}

void writeOdometry(const OdometryModel& model, MapUpdate& message) {
  const OdometryNoise& noise = model.noise;
  const SystematicErrors& errors = model.systematic;
  std::size_t at = 0;
  for (const double one : {noise.along_m_per_sqrt_m, noise.across_m_per_sqrt_m, noise.up_m_per_sqrt_m,
                           noise.heading_rad_per_sqrt_m, noise.heading_rad_per_sqrt_rad, noise.tilt_rad_per_sqrt_m}) {
    message.odometry_noise[at++] = static_cast<float>(one);
  }
  at = 0;
  for (const CoefficientEstimate& one : {errors.scale_translation, errors.scale_turn, errors.heading_rad_per_m,
                                         errors.direction_m_per_m, errors.lever_m_per_rad}) {
    message.odometry_errors[at++] = static_cast<float>(one.mean);
    message.odometry_errors[at++] = static_cast<float>(one.stddev);
  }
}

void writeKeyframes(const MapDelta& delta, MapUpdate& message) {
  const DeltaKeyframe& first = delta.keyframes.front();
  message.begins_session = delta.begins_session;
  write(first.T_previous_keyframe.translation_m, message.first_position);
  write(logRotation(first.T_previous_keyframe.rotation), message.first_rotation);
  message.begin = toRosTime(first.stamp);
  message.driven = first.driven.way_m;
  message.turned = first.driven.turn_rad;
  double longest_m = kMostSteps * kLeastKeyframeStep_m;
  for (std::size_t i = 1; i < delta.keyframes.size(); ++i) {
    longest_m = std::max(longest_m, delta.keyframes[i].T_previous_keyframe.translation_m.cwiseAbs().maxCoeff());
  }
  message.keyframe_step = static_cast<float>(longest_m / (kMostSteps - 1.0));
  for (std::size_t i = 1; i < delta.keyframes.size(); ++i) {
    const DeltaKeyframe& keyframe = delta.keyframes[i];
    const DeltaKeyframe& before = delta.keyframes[i - 1];
    MapUpdateKeyframe& one = message.keyframes.emplace_back();
    one.after = static_cast<float>(secondsFromStamp(keyframe.stamp - before.stamp));
    one.driven = static_cast<float>(keyframe.driven.way_m - before.driven.way_m);
    one.turned = static_cast<float>(keyframe.driven.turn_rad - before.driven.turn_rad);
    writeSteps(keyframe.T_previous_keyframe.translation_m, message.keyframe_step, one.position);
    writeSteps(logRotation(keyframe.T_previous_keyframe.rotation), kRotationStep_rad, one.rotation);
  }
}

void writeLandmarks(const MapDelta& delta, MapUpdate& message) {
  for (const DeltaLandmark& landmark : delta.landmarks) {
    MapUpdateLandmark& one = message.landmarks.emplace_back();
    one.id = static_cast<std::uint32_t>(landmark.id);
    one.class_index = static_cast<std::uint8_t>(landmark.class_index);
    one.class_prob = inParts(landmark.class_prob);
    one.existence_prob = inParts(landmark.existence_prob);
    one.observations = static_cast<std::uint8_t>(std::clamp(landmark.observations, 0, 255));
    one.keyframe = static_cast<std::uint8_t>(landmark.keyframe);
    writeSteps(landmark.position.mean_m, message.landmark_step, one.position);
    const Eigen::Matrix3d axes = axesAt(landmark.position.mean_m);
    const Eigen::Vector3d variances_m2 = (axes.transpose() * landmark.position.cov_m2 * axes).diagonal();
    for (std::size_t i = 0; i < 3; ++i) {
      one.stddev[i] = codeOf(variances_m2[static_cast<Eigen::Index>(i)], message.landmark_step);
    }
  }
  std::vector<bool> shown(delta.keyframes.size() * delta.landmarks.size());
  for (std::size_t k = 0; k < delta.keyframes.size(); ++k) {
    for (const std::size_t landmark : delta.keyframes[k].landmarks) shown[k * delta.landmarks.size() + landmark] = true;
  }
  message.shown = packed(shown);
  for (const auto& [second, earlier] : delta.duplicates) {
    message.duplicates.push_back(static_cast<std::uint32_t>(second));
    message.duplicates.push_back(static_cast<std::uint32_t>(earlier));
  }
}

void writeCovariance(const PoseCov& cov, MapUpdateClosure& message) {
  const PoseCov L = upperSquareRoot(cov).transpose();
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row) {
    const double stddev = L.row(row).norm();
    message.stddev[row] = static_cast<float>(stddev);
    for (int col = 0; col < row; ++col) {
      message.correlation[at++] = static_cast<std::int8_t>(std::round(kCorrelationSteps * L(row, col) / stddev));
    }
  }
}

void writeClosures(const MapDelta& delta, MapUpdate& message) {
  std::map<SameLandmark, std::uint16_t> places;
  for (const LoopClosureRecord& closure : delta.closures) {
    MapUpdateClosure& one = message.closures.emplace_back();
    one.source = static_cast<std::uint8_t>(closure.source);
    one.query_keyframe = static_cast<std::uint32_t>(closure.query_keyframe.index());
    one.match_keyframe = static_cast<std::uint32_t>(closure.match_keyframe.index());
    write(closure.T_match_query.translation_m, one.position);
    write(logRotation(closure.T_match_query.rotation), one.rotation);
    writeCovariance(closure.cov, one);
    one.inliers = static_cast<std::uint16_t>(std::clamp(closure.inliers, 0, 65535));
    for (const SameLandmark& pair : closure.pairs) {
      if (places.size() == kMostPairs && places.count(pair) == 0) continue;
      const auto [place, is_new] = places.emplace(pair, static_cast<std::uint16_t>(places.size()));
      one.pairs.push_back(place->second);
      if (!is_new) continue;
      message.pairs.push_back(static_cast<std::uint32_t>(pair.first));
      message.pairs.push_back(static_cast<std::uint32_t>(pair.second));
    }
  }
}

/// But for the lists that grow with the map.
MapUpdate toMessage(const SubmapContent& content, double range_factor, const ClassTable& classes) {
  const MapDelta delta = deltaOf(content);
  MapUpdate message;
  message.header.stamp = toRosTime(delta.end);
  message.number = static_cast<std::uint32_t>(content.submap->id.index());
  message.classes_digest = digestOf(classes);
  message.range_factor = static_cast<float>(range_factor);
  double farthest_m = 0.0;
  for (const DeltaLandmark& landmark : delta.landmarks) {
    farthest_m = std::max(farthest_m, landmark.position.mean_m.cwiseAbs().maxCoeff());
  }
  message.landmark_step = static_cast<float>(std::max(kLandmarkStep_m * range_factor, farthest_m / (kMostSteps - 1.0)));
  writeOdometry(delta.odometry, message);
  writeKeyframes(delta, message);
  writeLandmarks(delta, message);
  writeClosures(delta, message);
  return message;
}

}  // namespace

std::uint64_t digestOf(const ClassTable& classes) {
  std::string text;
  for (const ClassInfo& info : classes.all()) {
    text += std::to_string(info.id) + "|" + info.name + (info.is_static ? "|static\n" : "|movable\n");
  }
  return digestOf(text);
}

MapUpdate toMessage(const SlamParts& parts, SubmapId submap, const ClassTable& classes) {
  MapUpdate message = toMessage(contentOf(parts, submap), parts.range_factor, classes);
  message.closures_held = packed(heldClosures(parts.map));
  return message;
}

std::vector<MapUpdate> toMessages(const MapContent& content, const ClassTable& classes, const std::string& map_frame) {
  std::vector<MapUpdate> messages;
  for (const SubmapContent& submap : content.submaps) {
    messages.push_back(toMessage(submap, content.range_factor, classes));
    messages.back().header.frame_id = map_frame;
  }
  if (!messages.empty()) messages.back().closures_held = packed(content.held);
  return messages;
}

}  // namespace semantic_mht_slam
