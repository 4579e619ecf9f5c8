#include "semantic_mht_slam/bags/objects_gate.h"

#include <utility>

#include "semantic_mht_slam/bags/conversions.h"

namespace semantic_mht_slam {

void ObjectsGate::hold(const SemanticObjectArray& message, const OdometryGate& odometry, double now_s,
                       RefusedInput& refused) {
  if (!isUsableStamp(message.header.stamp)) {
    ++refused.objects_bad_stamps;
    return;
  }
  const Stamp stamp = toStamp(message.header.stamp);
  waiting_.push_back({message, odometry.isBack(stamp, newest_), now_s + timeout_s_});
  newest_ = stamp;
  if (waiting_.size() <= most_) return;
  waiting_.pop_front();
  ++refused.objects_given_up;
}

void ObjectsGate::clear(RefusedInput& refused) {
  refused.objects_given_up += waiting_.size();
  waiting_.clear();
}

std::optional<DetectorFrame> ObjectsGate::next(const OdometryGate& odometry, const std::optional<Stamp>& latest,
                                               double now_s, RefusedInput& refused) {
  while (!waiting_.empty()) {
    const Waiting& first = waiting_.front();
    const Stamp stamp = toStamp(first.message.header.stamp);
    SensorPlace place = sensors_.find(first.message.header.frame_id, stamp);
    const bool overtook_jump = first.falls_back && odometry.isBack(stamp, latest);
    const bool has_to_wait = place.answer == SensorPlace::Answer::kMayCome || overtook_jump;
    if (has_to_wait && now_s < first.deadline_s) return std::nullopt;
    if (place.answer == SensorPlace::Answer::kMayCome) {
      const std::optional<Pose> newest = sensors_.findNewest(first.message.header.frame_id);
      if (newest) place = {SensorPlace::Answer::kKnown, *newest, false};
    }
    const SemanticObjectArray message = std::move(waiting_.front().message);
    waiting_.pop_front();  // before anything can fail: a message is tried once
    if (isRefused(message, place.answer, refused)) continue;
    fixed_frame_ = place.is_by_odometry ? message.header.frame_id : std::string();
    for (const SemanticObject& object : message.objects) {
      if (!classes_.findId(object.class_id)) ++refused.unknown_classes[object.class_id];
    }
    std::size_t unknown_classes = 0;
    return DetectorFrame{stamp, fromMessage(message, classes_, place.T_base_sensor, unknown_classes), std::nullopt};
  }
  return std::nullopt;
}

bool ObjectsGate::isRefused(const SemanticObjectArray& message, SensorPlace::Answer answer,
                            RefusedInput& refused) const {
  if (answer == SensorPlace::Answer::kKnown) return false;
  if (answer == SensorPlace::Answer::kInMap) {
    ++refused.objects_in_map_frame;
  } else {
    ++refused.objects_without_transform;
    refused.unconnected_frame = message.header.frame_id;
  }
  return true;
}

}  // namespace semantic_mht_slam
