#include <algorithm>
#include <bitset>
#include <cmath>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/bags/map_update_conversions.h"
#include "semantic_mht_slam/common/error.h"
#include "semantic_mht_slam/common/ros_time.h"
#include "semantic_mht_slam/common/state_checks.h"

#include "map_update_codes.h"

namespace semantic_mht_slam {
namespace {

constexpr double kFarthest_m = 1e7;
constexpr std::size_t kMostShown = std::size_t{1} << 20U;  // objects of all keyframes of a submap
constexpr float kLargestStddev = 1e3F;                     // of any coefficient of an odometry

[[noreturn]] void refuse(const char* field, const std::string& problem) {
  throw InputError(std::string("map_update: field '") + field + "': " + problem);
}

void requireStep(const char* field, float step_m) {
  if (!(step_m > 1e-7F && step_m < 1e3F)) refuse(field, "out of range");
}

template <class Array>
Eigen::Vector3d readVector(const char* field, const Array& from) {
  const Eigen::Vector3d vector(from[0], from[1], from[2]);
  if (!vector.allFinite() || vector.cwiseAbs().maxCoeff() > kFarthest_m) refuse(field, "not finite, or far away");
  return vector;
}

/// The value of one bit in a list of bits.
bool bitAt(const std::vector<std::uint8_t>& bytes, std::size_t bit) {
  return (bytes[bit / 8] >> (bit % 8) & 1U) != 0;
}

void readOdometry(const MapUpdate& message, OdometryModel& model) {
  const auto number = [](const char* field, float value, float least) -> double {
    if (!(value >= least && value <= kLargestStddev)) refuse(field, "not finite, negative, or large");
    return value;
  };
  OdometryNoise& noise = model.noise;
  std::size_t at = 0;
  for (double* one : {&noise.along_m_per_sqrt_m, &noise.across_m_per_sqrt_m, &noise.up_m_per_sqrt_m,
                      &noise.heading_rad_per_sqrt_m, &noise.heading_rad_per_sqrt_rad, &noise.tilt_rad_per_sqrt_m}) {
    *one = number("odometry_noise", message.odometry_noise[at++], 0.0F);
  }
  SystematicErrors& errors = model.systematic;
  at = 0;
  for (CoefficientEstimate* one : {&errors.scale_translation, &errors.scale_turn, &errors.heading_rad_per_m,
                                   &errors.direction_m_per_m, &errors.lever_m_per_rad}) {
    one->mean = number("odometry_errors", message.odometry_errors[at++], -kLargestStddev);
    one->stddev = number("odometry_errors", message.odometry_errors[at++], 0.0F);
  }
}

void readKeyframes(const MapUpdate& message, MapDelta& delta) {
  delta.begins_session = message.begins_session != 0;
  DeltaKeyframe first;
  first.T_previous_keyframe = {expRotation(readVector("first_rotation", message.first_rotation)),
                               readVector("first_position", message.first_position)};
  first.stamp = toStamp(message.begin);
  const auto isWay = [](double way) { return way >= 0.0 && way < 1e9; };
  if (!isWay(message.driven) || !isWay(message.turned)) refuse("driven", "no way");
  first.driven = {message.driven, message.turned};
  delta.keyframes.push_back(first);
  requireStep("keyframe_step", message.keyframe_step);
  for (const MapUpdateKeyframe& keyframe : message.keyframes) {
    const auto isStep = [](float step) { return step >= 0.0F && step < 1e6F; };
    if (!isStep(keyframe.after) || !isStep(keyframe.driven) || !isStep(keyframe.turned)) {
      refuse("keyframes", "one before the one before");
    }
    const DeltaKeyframe& before = delta.keyframes.back();
    DeltaKeyframe read;
    read.stamp = before.stamp + stampFromSeconds(keyframe.after);
    if (!isRosTime(read.stamp)) refuse("begin", "at the end of the time of ROS");
    read.driven = before.driven + Motion{keyframe.driven, keyframe.turned};
    read.T_previous_keyframe = {expRotation(readSteps(keyframe.rotation, kRotationStep_rad)),
                                readSteps(keyframe.position, message.keyframe_step)};
    delta.keyframes.push_back(std::move(read));
  }
}

void readLandmarks(const MapUpdate& message, const ClassTable& classes, MapDelta& delta) {
  requireStep("landmark_step", message.landmark_step);
  for (const MapUpdateLandmark& landmark : message.landmarks) {
    if (landmark.class_index >= classes.size()) refuse("landmarks", "one of no known class");
    if (landmark.id <= (delta.landmarks.empty() ? kNoLandmark : delta.landmarks.back().id)) {
      refuse("landmarks", "ids that do not rise");
    }
    if (landmark.keyframe >= delta.keyframes.size()) refuse("landmarks", "one that no keyframe saw");
    DeltaLandmark read{landmark.id,
                       landmark.class_index,
                       landmark.class_prob / 255.0,
                       landmark.existence_prob / 255.0,
                       landmark.observations,
                       landmark.keyframe,
                       {}};
    read.position.mean_m = readSteps(landmark.position, message.landmark_step);
    Eigen::Vector3d variances_m2;
    for (int i = 0; i < 3; ++i) {
      variances_m2[i] = varianceOf(landmark.stddev[static_cast<std::size_t>(i)], message.landmark_step);
    }
    const Eigen::Matrix3d axes = axesAt(read.position.mean_m);
    read.position.cov_m2 = symmetric(axes * variances_m2.asDiagonal() * axes.transpose());
    delta.landmarks.push_back(std::move(read));
  }
}

void readShown(const MapUpdate& message, MapDelta& delta) {
  const std::size_t landmarks = delta.landmarks.size();
  if (message.shown.size() != (delta.keyframes.size() * landmarks + 7) / 8) {
    refuse("shown", "not a bit for each keyframe and landmark");
  }
  if (shownObjects(message) > kMostShown) refuse("shown", "more objects than a submap can show");
  std::vector<bool> is_shown(landmarks, false);
  for (std::size_t k = 0; k < delta.keyframes.size(); ++k) {
    for (std::size_t i = 0; i < landmarks; ++i) {
      if (!bitAt(message.shown, k * landmarks + i)) continue;
      delta.keyframes[k].landmarks.push_back(i);
      is_shown[i] = true;
    }
  }
  if (std::find(is_shown.begin(), is_shown.end(), false) != is_shown.end())
    refuse("shown", "a landmark by no keyframe");
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

PoseCov readCovariance(const MapUpdateClosure& message) {
  constexpr double kLeastOwn = 1e-4;  // of a variance, that no other error explains
  PoseCov L = PoseCov::Zero();
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col < row; ++col) L(row, col) = message.correlation[at++] / kCorrelationSteps;
    L(row, row) = std::sqrt(std::max(kLeastOwn, 1.0 - L.row(row).squaredNorm()));
    L.row(row) *= message.stddev[row] / L.row(row).norm();
  }
  const PoseCov cov = symmetric(L * L.transpose());
  if (!isPositive(cov)) refuse("closures", "a covariance that is not positive");
  return cov;
}

LoopClosureRecord readClosure(const MapUpdateClosure& message, const std::vector<SameLandmark>& pairs) {
  LoopClosureRecord closure;
  if (message.source > static_cast<std::uint8_t>(ClosureSource::kRequest)) refuse("closures", "an unknown source");
  closure.source = static_cast<ClosureSource>(message.source);
  closure.query_keyframe = KeyframeId(message.query_keyframe);
  closure.match_keyframe = KeyframeId(message.match_keyframe);
  if (closure.query_keyframe == closure.match_keyframe) refuse("closures", "a keyframe with itself");
  closure.T_match_query = {expRotation(readVector("closures", message.rotation)),
                           readVector("closures", message.position)};
  closure.cov = readCovariance(message);
  closure.inliers = message.inliers;
  for (const std::uint16_t place : message.pairs) {
    if (place >= pairs.size()) refuse("closures", "a pair that there is not");
    closure.pairs.push_back(pairs[place]);
  }
  return closure;
}

}  // namespace

std::size_t shownObjects(const MapUpdate& message) {
  std::size_t count = 0;
  for (const std::uint8_t byte : message.shown) count += std::bitset<8>(byte).count();
  return count;
}

MapDelta fromMessage(const MapUpdate& message, const ClassTable& classes) {
  if (message.classes_digest != digestOf(classes)) refuse("classes_digest", "that robot has another class table");
  if (!(message.range_factor > 1e-3F && message.range_factor < 1e3F)) refuse("range_factor", "out of range");
  MapDelta delta;
  delta.end = toStamp(message.header.stamp);
  readOdometry(message, delta.odometry);
  readKeyframes(message, delta);
  readLandmarks(message, classes, delta);
  readShown(message, delta);
  delta.duplicates = readPairs("duplicates", message.duplicates);
  if (delta.duplicates.size() > delta.landmarks.size()) refuse("duplicates", "more than landmarks");
  const std::vector<SameLandmark> pairs = readPairs("pairs", message.pairs);
  for (const MapUpdateClosure& closure : message.closures) delta.closures.push_back(readClosure(closure, pairs));
  return delta;
}

std::vector<bool> heldClosures(const MapUpdate& message) {
  std::vector<bool> held;
  for (std::size_t bit = 0; bit < 8 * message.closures_held.size(); ++bit) {
    held.push_back(bitAt(message.closures_held, bit));
  }
  return held;
}

}  // namespace semantic_mht_slam
