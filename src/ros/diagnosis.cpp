#include "semantic_mht_slam/ros/diagnosis.h"

#include <cmath>

#include "semantic_mht_slam/common/text.h"

#include "finding.h"
#include "topic_findings.h"

namespace semantic_mht_slam {
namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kOdometrySilence_s = 2.0;
constexpr double kClockOffset_s = 10.0;  // of stamps against the clock: more than a delay

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

namespace {

// Causes stand before their effects: the first finding is the message.

void findOdometryFault(const NodeStatus& now, const NodeStatus& before, const std::string& expected, Finding& finding) {
  const TopicStatus& odometry = now.odometry;
  const RefusedInput& refused = now.estimator.refused;
  const InputCounters& counters = now.estimator.counters;
  finding.error(odometry.received == 0 && now.running_s > kStart_s, "no odometry on " + odometry.topic,
                odometry.publishers == 0 ? "nobody publishes it: start the odometry, or remap odometry:=/its/topic"
                                         : "its publisher sends nothing: look at what it waits for");
  finding.error(odometry.silent_s.value_or(0.0) > kOdometrySilence_s && !hasEnded(now),
                "no odometry on " + odometry.topic + " for " + seconds(odometry.silent_s.value_or(0.0)),
                "look at the odometry's node, or at the player if this is a bag");
  finding.error(refused.odometry_wrong_frames > before.estimator.refused.odometry_wrong_frames,
                odometry.topic + " goes from " + refused.wrong_frames + ", expected is " + expected,
                "set node/odom_frame to its header.frame_id and node/base_frame to its child_frame_id");
  finding.error(
      counters.odometry_invalid > before.estimator.counters.odometry_invalid,
      odometry.topic + " holds poses that are not finite, or beyond 1e10 m, or whose quaternion has no unit norm",
      "mend the odometry's orientation: w = 1 for none, never all zero");
  finding.error(refused.odometry_bad_stamps > before.estimator.refused.odometry_bad_stamps,
                odometry.topic + " is stamped zero, or beyond the end of ROS's time (2106): dropped",
                "set header.stamp to the time of the measurement");
  finding.warn(refused.odometry_stamp_outliers > before.estimator.refused.odometry_stamp_outliers,
               odometry.topic + " holds single stamps far from the others: dropped",
               "look at the clock of the odometry's machine, and whether a second node publishes on the topic");
  finding.warn(counters.odometry_not_rising > before.estimator.counters.odometry_not_rising,
               odometry.topic + " holds stamps that do not rise",
               "let one node alone publish it, with a new header.stamp in every message");
  finding.warn(now.estimator.oddities.isOdometryInMillimetres(),
               odometry.topic + " moves at " + formatFixed(now.estimator.oddities.speed_m_per_s, 0) + " m/s",
               "give poses in metres, not in millimetres, and stamps in the time of the measurement");
  findLost(odometry, before.odometry, finding);
  finding.warn(counters.odometry_outliers > before.estimator.counters.odometry_outliers,
               odometry.topic + " holds single poses that no motion leads to: dropped",
               "look at what makes it leap for a message, and whether a second node publishes on the topic");
  finding.warn(now.estimator.odometry_jumps > before.estimator.odometry_jumps && !isOdometryLostInQueue(now, before),
               odometry.topic + " jumps: it goes on as another odometry, which looks for itself in the map",
               "look at what sets the odometry back or restarts it; it should be smooth");
}

}  // namespace

void diagnoseOdometry(const NodeStatus& now, const NodeStatus& before, DiagnosticStatusWrapper& status) {
  const TopicStatus& odometry = now.odometry;
  const InputCounters& counters = now.estimator.counters;
  const std::string expected = "'" + now.odom_frame + "' to '" + now.base_frame + "'";
  Finding finding(status);
  findOdometryFault(now, before, expected, finding);
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
  status.add("dropped, no motion leads there", counters.odometry_outliers);
  status.add("jumps", now.estimator.odometry_jumps);
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
