#include "semantic_mht_slam/ros/diagnosis.h"

#include <cmath>
#include <optional>

#include "semantic_mht_slam/common/text.h"

#include "finding.h"

namespace semantic_mht_slam {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kStart_s = 3.0;  // time to connect before silence is a fault
constexpr double kOdometrySilence_s = 2.0;
constexpr double kObjectsSilence_s = 10.0;  // detectors may be slow or see nothing for a while
constexpr double kClockSilence_s = 2.0;
constexpr double kApart_s = 1.0;         // frames before the very first odometry are no fault
constexpr double kClockOffset_s = 10.0;  // of stamps against the clock: more than a delay

std::string seconds(double value_s) {
  return formatFixed(value_s, 1) + " s";
}

void addTopic(const TopicStatus& topic, DiagnosticStatusWrapper& status) {
  status.add("topic", topic.topic);
  status.add("publishers", topic.publishers);
  status.add("messages", topic.received);
  status.add("lost before they came", topic.lost);
  status.add("rate (Hz)", formatFixed(topic.rate_hz, 2));
  if (topic.silent_s) status.add("silent for (s)", formatFixed(*topic.silent_s, 1));
  if (topic.stamp) status.add("newest stamp (s)", formatFixed(secondsFromStamp(*topic.stamp), 3));
  if (topic.delay_s) status.add("delay (s)", formatFixed(*topic.delay_s, 3));
}

void findLost(const TopicStatus& now, const TopicStatus& before, Finding& finding) {
  finding.warn(now.lost > before.lost,
               "messages of " + now.topic + " are lost before they come here, by the gaps in header.seq",
               "raise queue_size where they are published, and look at the network and at the load of this machine");
}

/// "class ids 7, 99", or empty.
std::string unknownClasses(const EstimatorStatus& now, const EstimatorStatus& before) {
  std::vector<std::string> ids;
  for (const auto& [id, count] : now.refused.unknown_classes) {
    const auto known = before.refused.unknown_classes.find(id);
    if (known == before.refused.unknown_classes.end() || known->second < count) ids.push_back(std::to_string(id));
  }
  if (ids.empty()) return {};
  return (ids.size() == 1 ? "class id " : "class ids ") + joined(ids);
}

void addUnknownClasses(const EstimatorStatus& estimator, DiagnosticStatusWrapper& status) {
  for (const auto& [id, count] : estimator.refused.unknown_classes) {
    status.add("objects of unknown class id " + std::to_string(id), count);
  }
}

/// A bag that is over is no fault, nor is the silence after it.
bool hasEnded(const NodeStatus& now) {
  return now.clock.use_sim_time && now.clock.still_s > kClockSilence_s && now.odometry.received > 0;
}

/// How far the newest objects' stamp lies from the newest odometry, in words.
std::string apart(const TopicStatus& objects) {
  if (!objects.delay_s) return {};
  return seconds(std::abs(*objects.delay_s)) + (*objects.delay_s < 0.0 ? " after" : " before");
}

}  // namespace

void diagnoseClock(const NodeStatus& now, const NodeStatus&, DiagnosticStatusWrapper& status) {
  const ClockStatus& clock = now.clock;
  const double off_s = now.odometry.delay_s.value_or(0.0);
  Finding finding(status);
  finding.error(clock.use_sim_time && !clock.time_s, "use_sim_time is true and nothing comes on /clock",
                "play the bag with --clock, or run 'rosparam set use_sim_time false' and start the node again");
  finding.warn(!clock.use_sim_time && std::abs(off_s) > kClockOffset_s,
               now.odometry.topic + " is stamped " + seconds(std::abs(off_s)) + (off_s > 0.0 ? " before" : " after") +
                   " the time of this machine",
               "for a bag: 'rosparam set use_sim_time true' before the nodes start, and play it with --clock; live: "
               "set the clocks of the machines (chrony, ntp)");
  finding.otherwise(hasEnded(now) ? "/clock stands still for " + seconds(clock.still_s) + ": paused, or the bag is over"
                    : clock.use_sim_time ? "/clock runs"
                                         : "time of this machine");
  status.add("use_sim_time", clock.use_sim_time ? "true" : "false");
  if (clock.time_s) status.add("time (s)", formatFixed(*clock.time_s, 3));
}

void diagnoseOdometry(const NodeStatus& now, const NodeStatus& before, DiagnosticStatusWrapper& status) {
  const TopicStatus& odometry = now.odometry;
  const InputCounters& counters = now.estimator.counters;
  const std::string expected = "'" + now.odom_frame + "' to '" + now.base_frame + "'";
  Finding finding(status);
  finding.error(odometry.received == 0 && now.running_s > kStart_s, "no odometry on " + odometry.topic,
                odometry.publishers == 0 ? "nobody publishes it: start the odometry, or remap odometry:=/its/topic"
                                         : "its publisher sends nothing: look at what it waits for");
  finding.error(odometry.silent_s.value_or(0.0) > kOdometrySilence_s && !hasEnded(now),
                "no odometry on " + odometry.topic + " for " + seconds(odometry.silent_s.value_or(0.0)),
                "look at the odometry's node, or at the player if this is a bag");
  finding.error(now.estimator.refused.odometry_wrong_frames > before.estimator.refused.odometry_wrong_frames,
                odometry.topic + " goes from " + now.estimator.refused.wrong_frames + ", expected is " + expected,
                "set node/odom_frame to its header.frame_id and node/base_frame to its child_frame_id");
  finding.error(
      counters.odometry_invalid > before.estimator.counters.odometry_invalid,
      odometry.topic + " holds poses that are not finite, or beyond 1e10 m, or whose quaternion has no unit norm",
      "mend the odometry's orientation: w = 1 for none, never all zero");
  finding.error(now.estimator.refused.odometry_bad_stamps > before.estimator.refused.odometry_bad_stamps,
                odometry.topic + " is stamped zero, or beyond the end of ROS's time (2106): dropped",
                "set header.stamp to the time of the measurement");
  finding.warn(now.estimator.refused.odometry_stamp_outliers > before.estimator.refused.odometry_stamp_outliers,
               odometry.topic + " holds single stamps far from the others: dropped",
               "look at the clock of the odometry's machine, and whether a second node publishes on the topic");
  finding.warn(now.estimator.odometry_jumps > before.estimator.odometry_jumps,
               odometry.topic + " jumps: it goes on as another odometry, which looks for itself in the map",
               "look at what sets the odometry back or restarts it; it should be smooth");
  finding.warn(now.estimator.oddities.isOdometryInMillimetres(),
               odometry.topic + " moves at " + formatFixed(now.estimator.oddities.speed_m_per_s, 0) + " m/s",
               "give poses in metres, not in millimetres, and stamps in the time of the measurement");
  finding.warn(counters.odometry_not_rising > before.estimator.counters.odometry_not_rising,
               odometry.topic + " holds stamps that do not rise",
               "let one node alone publish it, with a new header.stamp in every message");
  findLost(odometry, before.odometry, finding);
  finding.otherwise(odometry.received == 0 ? "waiting for odometry"
                                           : formatFixed(odometry.rate_hz, 1) + " Hz on " + odometry.topic);
  addTopic(odometry, status);
  status.add("expected frames", expected);
  status.add("used", counters.odometry);
  status.add("dropped, wrong frames", now.estimator.refused.odometry_wrong_frames);
  status.add("dropped, bad stamp", now.estimator.refused.odometry_bad_stamps);
  status.add("dropped, stamp far from the others", now.estimator.refused.odometry_stamp_outliers);
  status.add("dropped, invalid", counters.odometry_invalid);
  status.add("dropped, stamp does not rise", counters.odometry_not_rising);
  status.add("jumps", now.estimator.odometry_jumps);
}

namespace {

void findObjectsFault(const NodeStatus& now, const NodeStatus& before, Finding& finding) {
  const TopicStatus& objects = now.objects;
  const EstimatorStatus& estimator = now.estimator;
  const InputCounters& counters = estimator.counters;
  const InputCounters& old = before.estimator.counters;
  const std::string classes = unknownClasses(estimator, before.estimator);
  finding.warn(objects.received == 0 && now.running_s > kStart_s, "no objects on " + objects.topic,
               objects.publishers == 0
                   ? "nobody publishes them: start the detector, or remap objects:=/its/topic"
                   : "the detector sends nothing: it should send an empty array if it sees nothing");
  finding.error(estimator.refused.objects_bad_stamps > before.estimator.refused.objects_bad_stamps,
                objects.topic + " is stamped zero, or beyond the end of ROS's time (2106): dropped",
                "set header.stamp to the time of the scan or image");
  finding.error(estimator.refused.objects_without_transform > before.estimator.refused.objects_without_transform,
                "no transform from '" + estimator.refused.unconnected_frame + "' to '" + now.base_frame + "'",
                "publish where the sensor is: rosrun tf2_ros static_transform_publisher X Y Z YAW PITCH ROLL " +
                    now.base_frame + " " + estimator.refused.unconnected_frame);
  finding.error(estimator.refused.objects_in_map_frame > before.estimator.refused.objects_in_map_frame,
                objects.topic + " is in the frame of the map, or in one that hangs on it: dropped",
                "give objects in the frame of their sensor, of the robot, or of the odometry");
  finding.error(
      counters.frames_far_ahead > old.frames_far_ahead || counters.frames_before_odometry > old.frames_before_odometry,
      objects.topic + " is stamped " + apart(objects) + " the odometry: dropped",
      "stamp objects with the time of their scan or image, by the same clock as the odometry; "
      "input/odometry_history (" +
          seconds(now.odometry_history_s) + ") is how late they may be");
  finding.warn(!classes.empty(), classes + " on " + objects.topic + " not in the class table " + now.class_table,
               "add the id to the table, or give the table of this detector: class_table:=FILE");
  finding.warn(counters.detections_invalid > old.detections_invalid,
               objects.topic + " holds objects whose position, covariance, score or size cannot be used",
               "positions must be finite, covariances positive definite or all zero, scores in [0, 1] or -1");
  const InputOddities& oddities = estimator.oddities;
  finding.warn(oddities.areObjectsInMillimetres(),
               objects.topic + " holds objects " + formatFixed(oddities.range_m, 0) + " m away, half of them farther",
               "give positions in metres, not in millimetres");
  finding.warn(oddities.areObjectsOnEnd(),
               objects.topic + " holds objects " + formatFixed(oddities.height_m, 0) + " m above '" + now.base_frame +
                   "', higher than far",
               "camera axes (z ahead) need a frame that says so: header.frame_id of an optical frame that tf knows");
  finding.warn(oddities.areObjectsInWorld(), objects.topic + " holds objects that move along with the robot",
               "they seem to be in world coordinates: set header.frame_id to the frame that they are given in");
  finding.warn(counters.frames_not_rising > old.frames_not_rising, objects.topic + " holds stamps that do not rise",
               "let one detector alone publish it, in the order of its stamps");
  finding.warn(counters.frames_in_odometry_gap > old.frames_in_odometry_gap,
               objects.topic + " is stamped within a gap of the odometry", "odometry must not pause: see odometry");
  finding.warn(counters.frames_waiting_too_long > old.frames_waiting_too_long,
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
  addTopic(now.objects, status);
  status.add("frames used", counters.frames);
  status.add("objects used", counters.detections);
  status.add("dropped, bad stamp", now.estimator.refused.objects_bad_stamps);
  status.add("dropped, no transform", now.estimator.refused.objects_without_transform);
  status.add("dropped, in the map frame", now.estimator.refused.objects_in_map_frame);
  status.add("dropped, before the odometry", counters.frames_before_odometry);
  status.add("dropped, far ahead of the odometry", counters.frames_far_ahead);
  status.add("dropped, stamp does not rise", counters.frames_not_rising);
  status.add("dropped, in a gap of the odometry", counters.frames_in_odometry_gap);
  status.add("dropped, waited too long", counters.frames_waiting_too_long);
  status.add("objects dropped, unusable", counters.detections_invalid);
  addUnknownClasses(now.estimator, status);
}

void diagnoseQueue(const NodeStatus& now, const NodeStatus& before, DiagnosticStatusWrapper& status) {
  Finding finding(status);
  finding.warn(now.queue_dropped_odometry > before.queue_dropped_odometry, "the queue is full: odometry is dropped",
               "play the bag slower, or raise node/queue_size for bursts");
  finding.warn(
      now.queue_dropped_objects > before.queue_dropped_objects,
      "the estimator is too slow: the oldest objects are dropped",
      "play the bag slower, or make frames cheaper (fewer objects or hypotheses, docs/parameters.md); the pose "
      "goes on by odometry");
  finding.otherwise(std::to_string(now.queue_length) + " of " + std::to_string(now.queue_capacity) + " wait");
  status.add("waiting", now.queue_length);
  status.add("capacity", now.queue_capacity);
  status.add("dropped, odometry", now.queue_dropped_odometry);
  status.add("dropped, objects", now.queue_dropped_objects);
}

}  // namespace semantic_mht_slam
