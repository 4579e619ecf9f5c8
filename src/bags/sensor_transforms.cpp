#include "semantic_mht_slam/bags/sensor_transforms.h"

#include <algorithm>

#include <tf2/exceptions.h>

#include "semantic_mht_slam/bags/conversions.h"

namespace semantic_mht_slam {
namespace {

// Of a fixed sensor, between two look-ups: more than rounding, less than any calibration tells.
constexpr double kStill_m = 1e-6;
constexpr double kStill_rad = 1e-6;
constexpr std::size_t kMaxAncestors = 1000;  // tf with a circle

std::optional<Pose> lookUp(const tf2::BufferCore& transforms, const std::string& target, const std::string& source,
                           const ros::Time& time) {
  if (target == source) return Pose::identity();
  if (!transforms.canTransform(target, source, time)) return std::nullopt;
  try {
    const Pose pose = fromMessage(transforms.lookupTransform(target, source, time).transform);
    if (pose.isValid()) return pose;
  } catch (const tf2::TransformException&) {  // it was forgotten meanwhile
  }
  return std::nullopt;
}

SensorPlace known(const Pose& T_base_sensor) {
  return {SensorPlace::Answer::kKnown, T_base_sensor, false};
}

}  // namespace

std::string withoutSlash(const std::string& frame) {
  return !frame.empty() && frame.front() == '/' ? frame.substr(1) : frame;
}

SensorTransforms::SensorTransforms(const tf2::BufferCore& transforms, const NodeConfig& frames)
    : transforms_(transforms),
      map_frame_(frames.map_frame),
      odom_frame_(frames.odom_frame),
      base_frame_(frames.base_frame) {}

void SensorTransforms::addOdometry(const StampedPose& T_odom_base) {
  if (T_odom_base.T_world_base.isValid()) {
    odometry_.setTransform(toTransform(T_odom_base, odom_frame_, base_frame_), "odometry");
  }
}

SensorPlace SensorTransforms::find(const std::string& name, Stamp stamp) {
  const std::string frame = withoutSlash(name);
  if (frame == base_frame_) return known(Pose::identity());
  switch (sideOf(frame)) {
    case Side::kMap:
      return {SensorPlace::Answer::kInMap};
    case Side::kOdometry:
      return inOdometry(frame, toRosTime(stamp));
    case Side::kRobot:
      break;
  }
  return onRobot(frame, toRosTime(stamp));
}

/// The frame itself, its parent, and so on.
std::vector<std::string> SensorTransforms::ancestors(std::string frame) const {
  std::vector<std::string> chain{frame};
  while (chain.size() < kMaxAncestors && transforms_._getParent(frame, ros::Time(0), frame)) chain.push_back(frame);
  return chain;
}

/// What the way through the tree from a frame to the robot passes.
SensorTransforms::Side SensorTransforms::sideOf(const std::string& frame) const {
  const std::vector<std::string> up = ancestors(frame);
  std::vector<std::string> down = ancestors(base_frame_);
  if (std::find(down.begin(), down.end(), odom_frame_) == down.end()) {  // the messages of the odometry tie them alone
    const std::vector<std::string> of_odometry = ancestors(odom_frame_);
    down.insert(down.end(), of_odometry.begin(), of_odometry.end());
  }
  const auto top = std::find_first_of(up.begin(), up.end(), down.begin(), down.end());
  const bool is_connected = top != up.end();
  const auto down_end = is_connected ? std::find(down.begin(), down.end(), *top) + 1 : down.begin();
  const auto passes = [&](const std::string& name) {
    return std::find(up.begin(), is_connected ? top + 1 : up.end(), name) != (is_connected ? top + 1 : up.end()) ||
           std::find(down.begin(), down_end, name) != down_end;
  };
  if (passes(map_frame_)) return Side::kMap;
  return passes(odom_frame_) ? Side::kOdometry : Side::kRobot;
}

SensorPlace SensorTransforms::inOdometry(const std::string& frame, const ros::Time& time) const {
  const std::optional<Pose> T_odom_frame = lookUp(transforms_, odom_frame_, frame, time);
  const std::optional<Pose> T_odom_base = lookUp(odometry_, odom_frame_, base_frame_, time);
  if (!T_odom_frame || !T_odom_base) return {};
  return {SensorPlace::Answer::kKnown, T_odom_base->inverse() * *T_odom_frame, true};
}

SensorPlace SensorTransforms::onRobot(const std::string& frame, const ros::Time& time) {
  if (const std::optional<Pose> then = lookUp(transforms_, base_frame_, frame, time)) {
    Seen& seen = note(frame, *then, time);
    seen.is_settled = seen.is_settled || seen.first != time;
    return known(*then);
  }
  const auto seen = seen_.find(frame);
  if (seen == seen_.end() || !seen->second.is_settled) return {};
  const std::optional<Pose> newest = findNewest(frame);
  return newest ? known(*newest) : SensorPlace{};
}

std::optional<Pose> SensorTransforms::findNewest(const std::string& name) {
  const std::string frame = withoutSlash(name);
  if (sideOf(frame) != Side::kRobot) return std::nullopt;
  const std::optional<Pose> newest = lookUp(transforms_, base_frame_, frame, ros::Time(0));
  if (!newest) return std::nullopt;
  Seen& seen = note(frame, *newest, ros::Time(0));
  seen.is_settled = true;
  return seen.moves ? std::nullopt : newest;
}

SensorTransforms::Seen& SensorTransforms::note(const std::string& frame, const Pose& T_base_sensor,
                                               const ros::Time& time) {
  Seen& seen = seen_.try_emplace(frame, Seen{T_base_sensor, time, false, false}).first->second;
  const Pose step = seen.T_base_sensor.inverse() * T_base_sensor;
  if (step.translation_m.norm() > kStill_m || logRotation(step.rotation).norm() > kStill_rad) seen.moves = true;
  seen.T_base_sensor = T_base_sensor;
  return seen;
}

}  // namespace semantic_mht_slam
