#pragma once

#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nav_msgs/Path.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <semantic_mht_slam/LoadMap.h>
#include <semantic_mht_slam/SaveMap.h>

#include "support/running_node.h"
#include "support/square_drive.h"

namespace semantic_mht_slam {

/// A node that drives a simulated square.
class DrivingNode {
 public:
  explicit DrivingNode(const std::string& name, const std::vector<std::string>& parameters = {})
      : node(name, parameters), drive_(1) {
    odometry_ = node.handle().advertise<nav_msgs::Odometry>("odometry", 10000);
    objects_ = node.handle().advertise<SemanticObjectArray>("objects", 10000);
    trajectory_subscriber_ = node.handle().subscribe<nav_msgs::Path>(
        "trajectory", 10, boost::function<void(const nav_msgs::PathConstPtr&)>([this](const nav_msgs::PathConstPtr& m) {
          const std::lock_guard<std::mutex> lock(mutex_);
          trajectory_ = *m;
        }));
  }

  bool isReady() {
    return node.isReady() &&
           waitFor([this] { return odometry_.getNumSubscribers() > 0 && objects_.getNumSubscribers() > 0; });
  }

  /// Sends frames [begin, end) and waits until the node has used all frames up to `end`, or so many.
  bool feed(int begin, int end) { return feed(begin, end, end); }
  bool feed(int begin, int end, int frames_used) {
    for (int i = begin; i < end; ++i) {
      send(i);
      ros::WallDuration(0.002).sleep();
    }
    return waitFor([&] { return node.value("objects", "frames used") == std::to_string(frames_used); }, 60.0);
  }

  /// Sends one frame.
  void send(int i) {
    const StampedPose odometry{SquareDrive::stampAt(i), SquareDrive::odometryAt(i)};
    objects_.publish(toMessage(odometry.stamp, "base_link", drive_.detectionsAt(i), table_));
    odometry_.publish(toOdometry(odometry, "odom", "base_link"));
  }

  template <class Service>
  typename Service::Response call(const std::string& name, typename Service::Request request = {}) {
    return node.call<Service>(name, request);
  }

  SaveMap::Response save(const std::string& path) {
    SaveMap::Request request;
    request.path = path;
    return call<SaveMap>("save_map", request);
  }

  LoadMap::Response load(const std::string& path) {
    LoadMap::Request request;
    request.path = path;
    return call<LoadMap>("load_map", request);
  }

  /// The trajectory with `poses` poses that is published after everything was finished.
  std::vector<geometry_msgs::PoseStamped> finalTrajectory(std::size_t poses) {
    EXPECT_TRUE(call<std_srvs::Trigger>("finish_submap").success);
    ros::WallDuration(1.5).sleep();
    const std::lock_guard<std::mutex> lock(mutex_);
    EXPECT_EQ(trajectory_.poses.size(), poses);
    return trajectory_.poses;
  }

  RunningNode node;

 private:
  static ClassTable makeTable() {
    ClassTable street = makeStreetClasses();
    std::vector<ClassInfo> classes = street.all();
    classes[0].id = RunningNode::kPole;
    classes[1].id = 71;  // trunk
    return ClassTable(classes, "test");
  }

  SquareDrive drive_;
  ClassTable table_ = makeTable();
  ros::Publisher odometry_;
  ros::Publisher objects_;
  ros::Subscriber trajectory_subscriber_;
  std::mutex mutex_;
  nav_msgs::Path trajectory_;
};

}  // namespace semantic_mht_slam
