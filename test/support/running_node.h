#pragma once

#include <cmath>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <diagnostic_msgs/DiagnosticArray.h>
#include <gtest/gtest.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>

#include <semantic_mht_slam/SemanticObjectArray.h>

#include "semantic_mht_slam/bags/conversions.h"
#include "semantic_mht_slam/ros/service_call.h"

#include "support/ros_process.h"

namespace semantic_mht_slam {

/// Waits until `isTrue` holds, at most `limit_s` of wall time.
template <class Predicate>
bool waitFor(const Predicate& isTrue, double limit_s = 15.0) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(limit_s);
  while (!isTrue()) {
    if (ros::WallTime::now() > deadline) return false;
    ros::WallDuration(0.02).sleep();
  }
  return true;
}

/// A slam_node of its own for a test, under its own name with topics and services of its own, fed by the test. Needs a
/// running `Spinner`.
class RunningNode {
 public:
  explicit RunningNode(const std::string& name, std::vector<std::string> parameters = {})
      : name_(name), handle_("/" + name) {
    odometry_ = handle_.advertise<nav_msgs::Odometry>("odometry", 10000);
    objects_ = handle_.advertise<SemanticObjectArray>("objects", 10000);
    diagnostics_ = handle_.subscribe<diagnostic_msgs::DiagnosticArray>(
        "/diagnostics", 100, [this](const diagnostic_msgs::DiagnosticArrayConstPtr& message) { note(*message); });
    parameters.insert(parameters.begin(), {"__name:=" + name, "__ns:=/" + name});
    process_ = std::make_unique<RosProcess>("slam_node", parameters);
  }

  /// Topics and services of the node live here; the node is "/NAME/NAME".
  ros::NodeHandle& handle() { return handle_; }
  std::string fullName() const { return "/" + name_ + "/" + name_; }
  RosProcess& process() { return *process_; }

  /// Calls a service of the node and returns what it answers; fails the test if it does not answer.
  template <class Service>
  typename Service::Response call(const std::string& name, typename Service::Request request = {}) {
    Service call;
    call.request = request;
    EXPECT_TRUE(ros::service::waitForService(handle_.resolveName(name), ros::Duration(10.0)));
    EXPECT_TRUE(callService(handle_.resolveName(name), call)) << name;
    EXPECT_FALSE(call.response.message.empty());
    return call.response;
  }

  /// Waits until the node listens and reports.
  bool isReady() {
    return waitFor([this] {
      return odometry_.getNumSubscribers() > 0 && objects_.getNumSubscribers() > 0 &&
             !value("queue", "capacity").empty();
    });
  }

  /// Driven at 10 m/s; stays on Earth, whatever the clock.
  static double wayAt_m(double time_s) { return 10.0 * std::fmod(time_s, 1e6); }

  /// One odometry sample on a straight line.
  void sendOdometry(double time_s, const std::string& odom_frame = "odom") {
    const Pose pose{Eigen::Quaterniond::Identity(), {wayAt_m(time_s), 0.0, 0.0}};
    odometry_.publish(toOdometry({stampFromSeconds(kBegin_s + time_s), pose}, odom_frame, "base_link"));
  }

  /// Objects of one class around the base, in the base frame if not told otherwise, `back_m` farther back.
  void sendObjects(double time_s, int class_id = kPole, std::size_t count = 3, const std::string& frame = "base_link",
                   double back_m = 0.0) {
    SemanticObjectArray message;
    message.header.stamp = toRosTime(stampFromSeconds(kBegin_s + time_s));
    message.header.frame_id = frame;
    for (std::size_t i = 0; i < count; ++i) {
      SemanticObject object;
      object.class_id = static_cast<std::uint16_t>(class_id);
      object.position.x = 5.0 + 4.0 * static_cast<double>(i % 8) - back_m;
      object.position.y = -10.0 + 4.0 * static_cast<double>(i / 8);
      object.score = -1.0;
      message.objects.push_back(object);
    }
    objects_.publish(message);
  }

  /// A value of the newest diagnostics; empty before the first.
  std::string value(const std::string& part, const std::string& key) const {
    const diagnostic_msgs::DiagnosticStatus found = status(part);
    for (const auto& item : found.values) {
      if (item.key == key) return item.value;
    }
    return {};
  }

  diagnostic_msgs::DiagnosticStatus status(const std::string& part) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto found = statuses_.find(part);
    return found == statuses_.end() ? diagnostic_msgs::DiagnosticStatus() : found->second;
  }

  /// Waits until the newest diagnostics say so.
  bool comesToSay(const std::string& part, const std::string& key, const std::string& expected) const {
    return waitFor([&] { return value(part, key) == expected; });
  }
  bool comesToReport(const std::string& part, const std::string& message) const {
    return waitFor([&] { return status(part).message.find(message) != std::string::npos; });
  }

  static constexpr double kBegin_s = 1000.0;
  static constexpr int kPole = 80;  ///< in the SemanticKITTI table

 private:
  void note(const diagnostic_msgs::DiagnosticArray& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    const std::string prefix = fullName().substr(1) + ": ";
    for (const auto& status : message.status) {
      if (status.name.compare(0, prefix.size(), prefix) == 0) statuses_[status.name.substr(prefix.size())] = status;
    }
  }

  const std::string name_;
  ros::NodeHandle handle_;
  ros::Publisher odometry_;
  ros::Publisher objects_;
  ros::Subscriber diagnostics_;
  mutable std::mutex mutex_;
  std::map<std::string, diagnostic_msgs::DiagnosticStatus> statuses_;
  std::unique_ptr<RosProcess> process_;
};

}  // namespace semantic_mht_slam
