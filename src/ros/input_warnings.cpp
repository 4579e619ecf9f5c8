#include "semantic_mht_slam/ros/input_warnings.h"

#include <algorithm>
#include <cctype>
#include <iterator>

#include <ros/console.h>

namespace semantic_mht_slam {
namespace {

constexpr double kWarningPeriod_s = 5.0;

}  // namespace

void Warnings::warn(const std::string& text) {
  std::string kind;
  std::copy_if(text.begin(), text.end(), std::back_inserter(kind),
               [](unsigned char c) { return std::isdigit(c) == 0; });
  ros::WallTime& last = last_warning_[kind];
  const ros::WallTime now = ros::WallTime::now();
  if (now - last < ros::WallDuration(kWarningPeriod_s)) return;
  last = now;
  ROS_WARN_STREAM(text);
}

std::vector<std::string> droppedInput(const EstimatorStatus& status, std::size_t queue_dropped,
                                      const std::string& odometry_topic, const std::string& objects_topic,
                                      const std::string& base_frame) {
  const InputCounters& counters = status.counters;
  const std::string odometry = odometry_topic + ": ";
  const std::string objects = objects_topic + ": ";
  std::vector<std::string> lines;
  const auto report = [&](std::size_t count, const std::string& topic, const std::string& problem) {
    if (count > 0) lines.push_back(topic + std::to_string(count) + " " + problem);
  };
  report(queue_dropped, "", "messages dropped so far, the estimator is too slow (node/queue_size)");
  report(counters.odometry_invalid, odometry, "messages dropped so far: not finite, or a quaternion without unit norm");
  report(counters.odometry_not_rising, odometry, "messages dropped so far: the stamp does not rise");
  report(status.objects_without_transform, objects,
         "messages dropped so far: no transform from '" + status.unconnected_frame + "' to '" + base_frame + "'");
  for (const auto& [id, count] : status.unknown_classes) {
    report(count, objects, "objects dropped so far: class id '" + std::to_string(id) + "' is not in the class table");
  }
  report(counters.detections_invalid, objects,
         "objects dropped so far: position, covariance, score or size is unusable");
  report(counters.frames_before_odometry, objects, "messages dropped so far: older than the odometry");
  report(counters.frames_not_rising, objects, "messages dropped so far: the stamp does not rise");
  report(counters.frames_far_ahead, objects, "messages dropped so far: the stamp is far ahead of the odometry");
  report(counters.frames_in_odometry_gap, objects, "messages dropped so far: in a gap of the odometry");
  report(counters.frames_waiting_too_long, objects, "messages dropped so far: waited too long for odometry");
  return lines;
}

}  // namespace semantic_mht_slam
