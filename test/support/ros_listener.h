#pragma once

#include <functional>
#include <string>
#include <vector>

#include <ros/ros.h>
#include <rosgraph_msgs/Log.h>

namespace semantic_mht_slam {

/// Calls the queue until `is_done` or ten seconds have passed; what it returns at last.
inline bool spinUntil(const std::function<bool()>& is_done) {
  const ros::WallTime deadline = ros::WallTime::now() + ros::WallDuration(10.0);
  while (!is_done() && ros::WallTime::now() < deadline) {
    ros::spinOnce();
    ros::WallDuration(0.01).sleep();
  }
  return is_done();
}

/// Collects the warnings and errors on /rosout.
class WarningListener {
 public:
  explicit WarningListener(ros::NodeHandle& handle)
      : subscriber_(handle.subscribe<rosgraph_msgs::Log>("/rosout", 100, [this](const rosgraph_msgs::LogConstPtr& log) {
          if (log->level >= rosgraph_msgs::Log::WARN) texts_.push_back(log->msg);
        })) {}

  int count(const std::string& part) const {
    int found = 0;
    for (const std::string& text : texts_) found += text.find(part) != std::string::npos ? 1 : 0;
    return found;
  }

  std::string all() const {
    std::string result = "warnings:";
    for (const std::string& text : texts_) result += "\n  " + text;
    return result;
  }

  bool isConnected() const { return subscriber_.getNumPublishers() > 0; }

 private:
  std::vector<std::string> texts_;
  ros::Subscriber subscriber_;
};

}  // namespace semantic_mht_slam
