#include "semantic_mht_slam/ros/map_update_conversions.h"

#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/common/digest.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/ros_time.h"
#include "semantic_mht_slam/common/state_archive.h"
#include "semantic_mht_slam/common/state_checks.h"

namespace semantic_mht_slam {
namespace {

constexpr double kResolution_m = 0.01;  // of a detector that sees as far as the reference
constexpr double kMostSteps = 32767.0;
constexpr double kFarthest_m = 1e7;
constexpr int kCodeOfStep = 32;
constexpr double kCodesPerOctave = 8.0;

[[noreturn]] void refuse(const char* field, const std::string& problem) {
  throw InputError(std::string("map_update: field '") + field + "': " + problem);
}

/// Axes away from the base, across, up, as columns, where something is seen.
Eigen::Matrix3d axesAt(const Eigen::Vector3d& position_m) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  const double distance_m = position_m.head<2>().norm();
  if (distance_m < 1e-6) return axes;
  const Eigen::Vector2d away = position_m.head<2>() / distance_m;
  axes.col(0) << away, 0.0;
  axes.col(1) << -away.y(), away.x(), 0.0;
  return axes;
}

std::uint8_t codeOf(double variance_m2, double resolution_m) {
  const double octaves = 0.5 * std::log2(std::max(variance_m2, 1e-12)) - std::log2(resolution_m);
  return static_cast<std::uint8_t>(std::clamp(std::round(kCodeOfStep + kCodesPerOctave * octaves), 0.0, 255.0));
}

double varianceOf(std::uint8_t code, double resolution_m) {
  const double stddev_m = resolution_m * std::exp2((code - kCodeOfStep) / kCodesPerOctave);
  return stddev_m * stddev_m;
}

std::uint8_t inParts(double prob) {
  return static_cast<std::uint8_t>(std::lround(255.0 * std::clamp(prob, 0.0, 1.0)));
}

template <class Array>
void write(const Eigen::Vector3d& vector, Array& to) {
  for (std::size_t i = 0; i < 3; ++i) to[i] = static_cast<float>(vector[static_cast<Eigen::Index>(i)]);
}

template <class Array>
Eigen::Vector3d readVector(const char* field, const Array& from) {
  const Eigen::Vector3d vector(from[0], from[1], from[2]);
  if (!vector.allFinite() || vector.cwiseAbs().maxCoeff() > kFarthest_m) refuse(field, "not finite, or far away");
  return vector;
}

Pose readPose(const char* field, const geometry_msgs::Pose& message) {
  const Pose pose = fromMessage(message);
  if (!pose.isValid() || pose.translation_m.cwiseAbs().maxCoeff() > kFarthest_m) refuse(field, "no pose on Earth");
  return pose;
}

MapUpdateSighting toMessage(const DeltaSighting& seen, double resolution_m) {
  MapUpdateSighting message;
  message.landmark = static_cast<std::uint16_t>(seen.landmark);
  const Eigen::Matrix3d axes = axesAt(seen.position.mean_m);
  const Eigen::Vector3d variances_m2 = (axes.transpose() * seen.position.cov_m2 * axes).diagonal();
  for (int i = 0; i < 3; ++i) {
    const double steps = std::clamp(std::round(seen.position.mean_m[i] / resolution_m), -kMostSteps, kMostSteps);
    message.position[static_cast<std::size_t>(i)] = static_cast<std::int16_t>(steps);
    message.stddev[static_cast<std::size_t>(i)] = codeOf(variances_m2[i], resolution_m);
  }
  return message;
}

DeltaSighting fromMessage(const MapUpdateSighting& message, double resolution_m, std::size_t landmarks) {
  if (message.landmark >= landmarks) refuse("sightings", "one of no landmark");
  DeltaSighting seen;
  seen.landmark = message.landmark;
  Eigen::Vector3d variances_m2;
  for (int i = 0; i < 3; ++i) {
    seen.position.mean_m[i] = resolution_m * message.position[static_cast<std::size_t>(i)];
    variances_m2[i] = varianceOf(message.stddev[static_cast<std::size_t>(i)], resolution_m);
  }
  const Eigen::Matrix3d axes = axesAt(seen.position.mean_m);
  seen.position.cov_m2 = symmetric(axes * variances_m2.asDiagonal() * axes.transpose());
  return seen;
}

MapUpdateClosure toMessage(const LoopClosureRecord& closure) {
  MapUpdateClosure message;
  message.source = static_cast<std::uint8_t>(closure.source);
  message.query_keyframe = static_cast<std::uint32_t>(closure.query_keyframe.index());
  message.match_keyframe = static_cast<std::uint32_t>(closure.match_keyframe.index());
  write(closure.T_match_query.translation_m, message.position);
  write(logRotation(closure.T_match_query.rotation), message.rotation);
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row) {
    for (int col = row; col < 6; ++col) message.covariance[at++] = static_cast<float>(closure.cov(row, col));
  }
  message.inliers = static_cast<std::uint16_t>(std::clamp(closure.inliers, 0, 65535));
  for (const auto& [first, second] : closure.pairs) {
    message.pairs.push_back(static_cast<std::uint32_t>(first));
    message.pairs.push_back(static_cast<std::uint32_t>(second));
  }
  return message;
}

std::vector<SameLandmark> readPairs(const char* field, const std::vector<std::uint32_t>& numbers) {
  if (numbers.size() % 2 != 0) refuse(field, "an odd number of names");
  std::vector<SameLandmark> pairs;
  for (std::size_t i = 0; i < numbers.size(); i += 2) {
    if (numbers[i] == kNoLandmark || numbers[i + 1] == kNoLandmark) refuse(field, "a landmark of no name");
    pairs.emplace_back(numbers[i], numbers[i + 1]);
  }
  return pairs;
}

LoopClosureRecord fromMessage(const MapUpdateClosure& message) {
  LoopClosureRecord closure;
  if (message.source > static_cast<std::uint8_t>(ClosureSource::kRequest)) refuse("closures", "an unknown source");
  closure.source = static_cast<ClosureSource>(message.source);
  closure.query_keyframe = KeyframeId(message.query_keyframe);
  closure.match_keyframe = KeyframeId(message.match_keyframe);
  if (closure.query_keyframe == closure.match_keyframe) refuse("closures", "a keyframe with itself");
  closure.T_match_query = {expRotation(readVector("closures", message.rotation)),
                           readVector("closures", message.position)};
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row) {
    for (int col = row; col < 6; ++col) closure.cov(row, col) = closure.cov(col, row) = message.covariance[at++];
  }
  if (!isPositive(closure.cov)) refuse("closures", "a covariance that is not positive");
  closure.inliers = message.inliers;
  closure.pairs = readPairs("closures", message.pairs);
  return closure;
}

MapUpdateKeyframe toMessage(const DeltaKeyframe& keyframe, const DeltaKeyframe& first) {
  MapUpdateKeyframe message;
  const Pose T_first_base = first.T_odom_base.inverse() * keyframe.T_odom_base;
  message.after = static_cast<float>(secondsFromStamp(keyframe.stamp - first.stamp));
  message.driven = static_cast<float>(keyframe.driven.way_m - first.driven.way_m);
  message.turned = static_cast<float>(keyframe.driven.turn_rad - first.driven.turn_rad);
  write(T_first_base.translation_m, message.position);
  write(logRotation(T_first_base.rotation), message.rotation);
  message.sightings = static_cast<std::uint16_t>(keyframe.sightings.size());
  return message;
}

std::string bytesOf(OdometryModel model) {
  StateArchive archive;
  archive(model);
  return archive.written();
}

std::vector<std::uint8_t> packed(const std::vector<bool>& values) {
  std::vector<std::uint8_t> bytes((values.size() + 7) / 8);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (values[i]) bytes[i / 8] = static_cast<std::uint8_t>(bytes[i / 8] | 1U << (i % 8));
  }
  return bytes;
}

void readLandmarks(const MapUpdate& message, const ClassTable& classes, MapDelta& delta) {
  for (const MapUpdateLandmark& landmark : message.landmarks) {
    if (landmark.class_index >= classes.size()) refuse("landmarks", "one of no known class");
    if (landmark.id <= (delta.landmarks.empty() ? kNoLandmark : delta.landmarks.back().id)) {
      refuse("landmarks", "ids that do not rise");
    }
    delta.landmarks.push_back({landmark.id, landmark.class_index, landmark.class_prob / 255.0,
                               landmark.existence_prob / 255.0, landmark.observations});
  }
}

void readKeyframes(const MapUpdate& message, MapDelta& delta) {
  const Pose T_odom_first = readPose("odom_base", message.odom_base);
  const Stamp begin = toStamp(message.begin);
  if (!(message.driven >= 0.0 && message.driven < 1e9 && message.turned >= 0.0 && message.turned < 1e9)) {
    refuse("driven", "no way");
  }
  std::vector<bool> is_seen(delta.landmarks.size(), false);
  auto seen = message.sightings.begin();
  for (const MapUpdateKeyframe& keyframe : message.keyframes) {
    DeltaKeyframe& read = delta.keyframes.emplace_back();
    if (!(keyframe.after >= 0.0F && keyframe.after < 1e6F && keyframe.driven >= 0.0F && keyframe.driven < 1e6F &&
          keyframe.turned >= 0.0F && keyframe.turned < 1e6F)) {
      refuse("keyframes", "one before the first");
    }
    read.stamp = begin + stampFromSeconds(keyframe.after);
    if (!isRosTime(read.stamp)) refuse("begin", "at the end of the time of ROS");
    read.driven = {message.driven + keyframe.driven, message.turned + keyframe.turned};
    read.T_odom_base = T_odom_first * Pose{expRotation(readVector("keyframes", keyframe.rotation)),
                                           readVector("keyframes", keyframe.position)};
    if (message.sightings.end() - seen < keyframe.sightings) refuse("keyframes", "more sightings than there are");
    for (int i = 0; i < keyframe.sightings; ++i, ++seen) {
      read.sightings.push_back(fromMessage(*seen, message.resolution, delta.landmarks.size()));
      is_seen[seen->landmark] = true;
    }
  }
  if (seen != message.sightings.end()) refuse("sightings", "more than the keyframes have");
  if (delta.keyframes.empty()) refuse("keyframes", "none");
  if (std::find(is_seen.begin(), is_seen.end(), false) != is_seen.end()) refuse("landmarks", "one that nobody saw");
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
  const MapDelta delta = deltaOf(parts, submap);
  MapUpdate message;
  const DeltaKeyframe& first = delta.keyframes.front();
  message.header.stamp = toRosTime(delta.end);
  message.version = MapUpdate::VERSION;
  message.number = static_cast<std::uint32_t>(submap.index());
  message.classes_digest = digestOf(classes);
  message.range_factor = static_cast<float>(parts.range_factor);
  message.resolution = static_cast<float>(kResolution_m * parts.range_factor);
  const std::string model = bytesOf(delta.odometry);
  message.odometry_model.assign(model.begin(), model.end());
  message.begins_session = delta.T_map_odom.has_value();
  message.map_odom = toMessage(delta.T_map_odom.value_or(Pose::identity()));
  message.begin = toRosTime(first.stamp);
  message.driven = first.driven.way_m;
  message.turned = first.driven.turn_rad;
  message.odom_base = toMessage(first.T_odom_base);
  for (const DeltaLandmark& landmark : delta.landmarks) {
    MapUpdateLandmark& one = message.landmarks.emplace_back();
    one.id = static_cast<std::uint32_t>(landmark.id);
    one.class_index = static_cast<std::uint8_t>(landmark.class_index);
    one.class_prob = inParts(landmark.class_prob);
    one.existence_prob = inParts(landmark.existence_prob);
    one.observations = static_cast<std::uint16_t>(std::clamp(landmark.observations, 0, 65535));
  }
  for (const auto& [second, earlier] : delta.duplicates) {
    message.duplicates.push_back(static_cast<std::uint32_t>(second));
    message.duplicates.push_back(static_cast<std::uint32_t>(earlier));
  }
  for (const DeltaKeyframe& keyframe : delta.keyframes) {
    message.keyframes.push_back(toMessage(keyframe, first));
    for (const DeltaSighting& seen : keyframe.sightings) {
      message.sightings.push_back(toMessage(seen, message.resolution));
    }
  }
  for (const LoopClosureRecord& closure : delta.closures) message.closures.push_back(toMessage(closure));
  message.closures_held = packed(heldClosures(parts.map));
  return message;
}

MapDelta fromMessage(const MapUpdate& message, const ClassTable& classes) {
  if (message.version != MapUpdate::VERSION) {
    refuse("version", std::to_string(message.version) + ", this program reads " + std::to_string(MapUpdate::VERSION));
  }
  if (message.classes_digest != digestOf(classes)) refuse("classes_digest", "that robot has another class table");
  if (!(message.range_factor > 1e-3F && message.range_factor < 1e3F)) refuse("range_factor", "out of range");
  if (!(message.resolution > 1e-6F && message.resolution < 1e3F)) refuse("resolution", "out of range");
  MapDelta delta;
  delta.end = toStamp(message.header.stamp);
  try {
    const std::string bytes(message.odometry_model.begin(), message.odometry_model.end());
    StateArchive archive(bytes);
    archive(delta.odometry);
    archive.requireEnd();
  } catch (const InputError& error) {
    refuse("odometry_model", error.what());
  }
  if (message.begins_session) delta.T_map_odom = readPose("map_odom", message.map_odom);
  readLandmarks(message, classes, delta);
  delta.duplicates = readPairs("duplicates", message.duplicates);
  readKeyframes(message, delta);
  for (const MapUpdateClosure& closure : message.closures) delta.closures.push_back(fromMessage(closure));
  return delta;
}

std::vector<bool> heldClosures(const MapUpdate& message) {
  std::vector<bool> held;
  for (const std::uint8_t byte : message.closures_held) {
    for (unsigned bit = 0; bit < 8; ++bit) held.push_back((byte >> bit & 1U) != 0);
  }
  return held;
}

}  // namespace semantic_mht_slam
