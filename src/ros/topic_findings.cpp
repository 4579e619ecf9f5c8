#include "topic_findings.h"

#include "semantic_mht_slam/common/text.h"

namespace semantic_mht_slam {
namespace {

constexpr double kClockSilence_s = 2.0;

}  // namespace

std::string seconds(double value_s) {
  return formatFixed(value_s, 1) + " s";
}

void addTopic(const TopicStatus& topic, diagnostic_updater::DiagnosticStatusWrapper& status) {
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

bool isOdometryLostInQueue(const NodeStatus& now, const NodeStatus& before) {
  return now.queue_dropped_odometry > before.queue_dropped_odometry;
}

bool hasEnded(const NodeStatus& now) {
  return now.clock.use_sim_time && now.clock.still_s > kClockSilence_s && now.odometry.received > 0;
}

}  // namespace semantic_mht_slam
