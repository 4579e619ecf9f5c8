#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <ros/ros.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/ros/input_queue.h"
#include "semantic_mht_slam/ros/time_jump_guard.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// The ROS node. Subscribers put messages into a bounded queue; one worker thread owns the estimator, takes them out,
/// and publishes tf map -> odom, `pose`, `markers/objects`, `hypotheses` and `map`; a wall timer publishes `trajectory`
/// (latched) when it has changed, so that the last one goes out even if the clock of a replay has stopped.
class SlamNode {
 public:
  SlamNode(const ros::NodeHandle& handle, const SystemConfig& config, const ClassTable& classes);

  /// Stops the worker; messages that still wait are given up.
  ~SlamNode();

  SlamNode(const SlamNode&) = delete;
  SlamNode& operator=(const SlamNode&) = delete;

 private:
  /// Objects whose sensor is not known to tf yet.
  struct WaitingObjects {
    SemanticObjectArray message;
    ros::WallTime deadline;
  };

  void work();
  void handle(const nav_msgs::Odometry& message);
  void handle(const SemanticObjectArray& message);
  bool isExpectedFrame(const nav_msgs::Odometry& message);
  void warn(const std::string& text);
  void process(const nav_msgs::Odometry& message);
  std::optional<Stamp> latestStamp() const;
  void startAgain(Stamp stamp);
  void retryObjects();
  void publishPose();
  void publishObjects();
  void publishTrajectory(const ros::WallTimerEvent& event);
  void reportProblems();
  std::optional<Pose> findSensor(const std::string& sensor_frame);

  ros::NodeHandle handle_;
  const SystemConfig config_;
  const ClassTable classes_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  tf2_ros::TransformBroadcaster transform_broadcaster_;
  ros::Publisher pose_publisher_;
  ros::Publisher trajectory_publisher_;
  ros::Publisher objects_publisher_;
  ros::Publisher hypotheses_publisher_;
  ros::Publisher map_publisher_;

  // Owned by the worker, but for the trajectory that the timer publishes.
  std::unique_ptr<Slam> slam_;
  TimeJumpGuard jump_;
  std::map<std::string, Pose> T_base_sensor_;
  std::deque<WaitingObjects> waiting_objects_;
  std::size_t without_transform_ = 0;
  std::string unconnected_frame_;
  std::map<std::string, ros::WallTime> last_warning_;  ///< by the text without its numbers
  std::size_t unknown_classes_ = 0;
  std::mutex slam_mutex_;
  std::size_t published_odometry_ = 0;
  std::optional<Stamp> published_frame_;
  std::size_t published_submaps_ = 0;

  InputQueue queue_;
  ros::Subscriber odometry_subscriber_;
  ros::Subscriber objects_subscriber_;
  ros::WallTimer trajectory_timer_;
  std::thread worker_;
};

}  // namespace semantic_mht_slam
