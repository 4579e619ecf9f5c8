#include <algorithm>
#include <cmath>

#include "semantic_mht_slam/common/text.h"
#include "semantic_mht_slam/ros/diagnosis.h"

#include "topic_findings.h"

namespace semantic_mht_slam {

using diagnostic_updater::DiagnosticStatusWrapper;

namespace {

constexpr double kObjectsSilence_s = 10.0;  // detectors may be slow or see nothing for a while
constexpr const char* kFixOfOrigin =
    "the detector, or what converts its messages, leaves positions empty: fill them in, and leave out objects that "
    "have "
    "no range";

/// Objects of unknown classes that were dropped since `before`.
UnknownClassList unknownClasses(const EstimatorStatus& now, const EstimatorStatus& before) {
  std::map<int, std::size_t> newly_dropped;
  for (const auto& [id, count] : now.refused.unknown_classes) {
    const auto known = before.refused.unknown_classes.find(id);
    const std::size_t old_count = known == before.refused.unknown_classes.end() ? 0 : known->second;
    if (count > old_count) newly_dropped[id] = count - old_count;
  }
  return listOf(newly_dropped);
}

void addUnknownClasses(const EstimatorStatus& estimator, DiagnosticStatusWrapper& status) {
  const UnknownClassList unknown = listOf(estimator.refused.unknown_classes);
  for (const auto& [id, count] : unknown.listed) {
    status.add("objects of unknown class id " + std::to_string(id), count);
  }
  if (unknown.others == 0) return;
  status.add("other unknown class ids", unknown.others);
  status.add("objects of other unknown class ids", unknown.objects_of_others);
}

/// A detector may say 0, 0, 0 of what it cannot range; of most objects it does not.
bool areMostAtOrigin(const InputCounters& now, const InputCounters& before) {
  const std::size_t at_origin =
      now.detections_at_origin - std::min(before.detections_at_origin, now.detections_at_origin);
  const std::size_t used = now.detections - std::min(before.detections, now.detections);
  return at_origin > 0 && at_origin >= used;
}

/// How far the newest objects' stamp lies from the newest odometry, in words.
std::string apart(const TopicStatus& objects) {
  if (!objects.delay_s) return {};
  return seconds(std::abs(*objects.delay_s)) + (*objects.delay_s < 0.0 ? " after" : " before");
}

// Causes stand before their effects: the first finding is the message.

void findObjectsStampFault(const NodeStatus& now, const NodeStatus& before, Finding& finding) {
  const TopicStatus& objects = now.objects;
  const InputCounters& counters = now.estimator.counters;
  const InputCounters& old = before.estimator.counters;
  finding.error(now.estimator.refused.objects_bad_stamps > before.estimator.refused.objects_bad_stamps,
                objects.topic + " is stamped zero, or beyond the end of ROS's time (2106): dropped",
                "set header.stamp to the time of the scan or image");
  finding.error(
      counters.frames_far_ahead > old.frames_far_ahead || counters.frames_before_odometry > old.frames_before_odometry,
      objects.topic + " is stamped " + apart(objects) + " the odometry: dropped",
      "stamp objects with the time of their scan or image, by the same clock as the odometry; "
      "input/odometry_history (" +
          seconds(now.odometry_history_s) + ") is how late they may be");
}

void findObjectsPlaceFault(const NodeStatus& now, const NodeStatus& before, Finding& finding) {
  const TopicStatus& objects = now.objects;
  const EstimatorStatus& estimator = now.estimator;
  const InputCounters& old = before.estimator.counters;
  const std::string classes = unknownClasses(estimator, before.estimator).text();
  finding.error(estimator.refused.objects_without_transform > before.estimator.refused.objects_without_transform,
                "no transform from '" + estimator.refused.unconnected_frame + "' to '" + now.base_frame + "'",
                "publish where the sensor is: rosrun tf2_ros static_transform_publisher X Y Z YAW PITCH ROLL " +
                    now.base_frame + " " + estimator.refused.unconnected_frame);
  finding.error(estimator.refused.objects_in_map_frame > before.estimator.refused.objects_in_map_frame,
                objects.topic + " is in the frame of the map, or in one that hangs on it: dropped",
                "give objects in the frame of their sensor, of the robot, or of the odometry");
  finding.warn(!classes.empty(), classes + " on " + objects.topic + " not in the class table " + now.class_table,
               "add the id to the table, or give the table of this detector: class_table:=FILE");
  finding.warn(estimator.counters.detections_invalid > old.detections_invalid,
               objects.topic + " holds objects whose position, covariance, score or size cannot be used",
               "positions must be finite, covariances positive definite or all zero, scores in [0, 1] or -1");
  finding.warn(areMostAtOrigin(estimator.counters, old),
               objects.topic + " holds objects at exactly 0, 0, 0 of their frame: dropped", kFixOfOrigin);
  const InputOddities& oddities = estimator.oddities;
  finding.warn(oddities.areObjectsInWorld(), objects.topic + " holds objects that move along with the robot",
               "they seem to be in world coordinates: set header.frame_id to the frame that they are given in");
  finding.warn(oddities.areObjectsInMillimetres(),
               objects.topic + " holds objects " + formatFixed(oddities.range_m, 0) + " m away, half of them farther",
               "give positions in metres, not in millimetres");
  finding.warn(oddities.areObjectsOnEnd(),
               objects.topic + " holds objects " + formatFixed(oddities.height_m, 0) + " m above '" + now.base_frame +
                   "', higher than far",
               "camera axes (z ahead) need a frame that says so: header.frame_id of an optical frame that tf knows");
}

void findObjectsFault(const NodeStatus& now, const NodeStatus& before, Finding& finding) {
  const TopicStatus& objects = now.objects;
  const InputCounters& counters = now.estimator.counters;
  const InputCounters& old = before.estimator.counters;
  const bool is_queue_full = isOdometryLostInQueue(now, before);
  finding.warn(objects.received == 0 && now.running_s > kStart_s, "no objects on " + objects.topic,
               objects.publishers == 0
                   ? "nobody publishes them: start the detector, or remap objects:=/its/topic"
                   : "the detector sends nothing: it should send an empty array if it sees nothing");
  findObjectsStampFault(now, before, finding);
  findObjectsPlaceFault(now, before, finding);
  finding.warn(counters.frames_not_rising > old.frames_not_rising, objects.topic + " holds stamps that do not rise",
               "let one detector alone publish it, in the order of its stamps");
  finding.warn(counters.frames_in_odometry_gap > old.frames_in_odometry_gap && !is_queue_full,
               objects.topic + " is stamped within a gap of the odometry", "odometry must not pause: see odometry");
  finding.warn(counters.frames_waiting_too_long > old.frames_waiting_too_long && !is_queue_full,
               objects.topic + " waits for odometry in vain", "see odometry");
  findLost(objects, before.objects, finding);
  finding.warn(objects.silent_s.value_or(0.0) > kObjectsSilence_s && !hasEnded(now),
               "no objects on " + objects.topic + " for " + seconds(objects.silent_s.value_or(0.0)),
               "look at the detector; the pose goes on by odometry alone");
}

}  // namespace

void diagnoseObjects(const NodeStatus& now, const NodeStatus& before, DiagnosticStatusWrapper& status) {
  const InputCounters& counters = now.estimator.counters;
  Finding finding(status);
  findObjectsFault(now, before, finding);
  finding.otherwise(now.objects.received == 0 ? "waiting for objects"
                                              : formatFixed(now.objects.rate_hz, 1) + " Hz on " + now.objects.topic);
  if (const std::string& frame = now.estimator.objects_fixed_frame; !frame.empty()) {
    status.add(kNoteKey, now.objects.topic + " is given in '" + frame +
                             "', which does not move with the robot: the odometry brings it to '" + now.base_frame +
                             "' at its stamp. Give what the sensor sees in the frame of the sensor: objects that a "
                             "tracker remembers count as seen anew in every message");
  }
  const InputCounters& old = before.estimator.counters;
  if (counters.detections_at_origin > old.detections_at_origin && !areMostAtOrigin(counters, old)) {
    status.add(kNoteKey, "some objects on " + now.objects.topic +
                             " lie at exactly 0, 0, 0 of their frame and are dropped: " + std::string(kFixOfOrigin));
  }
  addTopic(now.objects, status);
  status.add("frames used", counters.frames);
  status.add("frames not looked at, standing", counters.frames_standing);
  status.add("objects used", counters.detections);
  status.add("dropped, bad stamp", now.estimator.refused.objects_bad_stamps);
  status.add("dropped, no transform", now.estimator.refused.objects_without_transform);
  status.add("dropped, in the map frame", now.estimator.refused.objects_in_map_frame);
  status.add("dropped, before the odometry", counters.frames_before_odometry);
  status.add("dropped, far ahead of the odometry", counters.frames_far_ahead);
  status.add("dropped, stamp does not rise", counters.frames_not_rising);
  status.add("dropped, in a gap of the odometry", counters.frames_in_odometry_gap);
  status.add("dropped, waited too long", counters.frames_waiting_too_long);
  status.add("dropped, given up", now.estimator.refused.objects_given_up);
  status.add("objects dropped, unusable", counters.detections_invalid);
  status.add("objects dropped, at 0, 0, 0", counters.detections_at_origin);
  status.add("covariances left out, unusable", counters.covariances_unknown);
  addUnknownClasses(now.estimator, status);
}

}  // namespace semantic_mht_slam
