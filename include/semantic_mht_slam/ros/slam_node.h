#pragma once

#include <atomic>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <semantic_mht_slam/AddClosure.h>
#include <semantic_mht_slam/GetLandmarks.h>
#include <semantic_mht_slam/GetMapUpdates.h>
#include <semantic_mht_slam/LoadMap.h>
#include <semantic_mht_slam/LockLandmark.h>
#include <semantic_mht_slam/RemoveClosure.h>
#include <semantic_mht_slam/RemoveLandmark.h>
#include <semantic_mht_slam/SaveMap.h>
#include <semantic_mht_slam/SaveResults.h>
#include <semantic_mht_slam/SetMode.h>

#include "semantic_mht_slam/app/system_config.h"
#include "semantic_mht_slam/bags/objects_gate.h"
#include "semantic_mht_slam/bags/odometry_gate.h"
#include "semantic_mht_slam/bags/sensor_transforms.h"
#include "semantic_mht_slam/models/class_table.h"
#include "semantic_mht_slam/ros/failure_guard.h"
#include "semantic_mht_slam/ros/input_plausibility.h"
#include "semantic_mht_slam/ros/input_queue.h"
#include "semantic_mht_slam/ros/live_parameters.h"
#include "semantic_mht_slam/ros/node_diagnostics.h"
#include "semantic_mht_slam/ros/slam_publisher.h"
#include "semantic_mht_slam/ros/throttled_warnings.h"
#include "semantic_mht_slam/ros/ticket_mutex.h"
#include "semantic_mht_slam/slam/slam.h"

namespace semantic_mht_slam {

/// The ROS node, in a process of its own or in that of a nodelet manager. Subscribers put messages into a bounded
/// queue; one worker thread owns the estimator, takes them out and publishes; a wall timer publishes `trajectory` when
/// it has changed, so that the last one goes out even if the clock of a replay has stopped. Services have a thread,
/// too, so that messages keep coming while a map is saved or loaded; they come after the messages that the node
/// received before the request, and change the estimator between two messages. Odometry that the worker does not come
/// to goes out as a pose by odometry alone. A failure that nobody foresaw drops its message; after three in a row the
/// estimator stands still and the pose goes on by odometry alone, until `reset` or `load_map`.
class SlamNode {
 public:
  /// `slam`: of `startingSlam`.
  SlamNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle, const SystemConfig& config,
           const ClassTable& classes, std::unique_ptr<Slam> slam);

  /// Stops the worker; messages that still wait are given up.
  ~SlamNode();

  SlamNode(const SlamNode&) = delete;
  SlamNode& operator=(const SlamNode&) = delete;

 private:
  /// Odometry that the worker has not come to.
  struct UnhandledOdometry {
    nav_msgs::OdometryConstPtr message;
    ros::WallTime since;
  };

  void receive(const nav_msgs::OdometryConstPtr& message, const std::string& publisher);
  void receive(const SemanticObjectArrayConstPtr& message, const std::string& publisher);
  void receive(const sensor_msgs::NavSatFixConstPtr& message) { queue_.push(message); }
  void subscribe();
  void advertiseServices();
  void advertiseRequests(ros::NodeHandle& handle);

  // The worker.
  void work();
  void handleSafely(const InputMessage& message);
  void noteHandled(const InputMessage& message);
  void handleTimed(const InputMessage& message);
  void deadReckon(const nav_msgs::Odometry& message);
  void warnOfDrops();
  void handle(const nav_msgs::Odometry& message);
  void handle(const SemanticObjectArray& message);
  void handle(const sensor_msgs::NavSatFix& message);
  void process(const nav_msgs::Odometry& message);
  void beginSessionUnlessGoingOn(const nav_msgs::Odometry& message);
  std::optional<Stamp> latestStamp() const;
  void retryObjects();
  void noteWay(const StampedPose& T_odom_base);
  void noteStatus();

  // With the estimator locked.
  void startAgain();
  void publishMap();

  // Subscribers, diagnostics and the timer of overdue poses, in the spinner thread.
  void publishOverduePose();

  // Services and `initialpose`, in a thread of their own.

  /// The estimator for a service: it has seen every message that the node received before the request.
  std::unique_lock<TicketMutex> lockCaughtUp();
  void waitForSubscribers();
  /// Lets `body` answer; a failure becomes the answer. Always true: the service was called.
  template <class Response, class Body>
  bool answer(const std::string& service, Response& response, const Body& body);
  bool finishSubmap(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool pause(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool resume(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void expectAt(const geometry_msgs::PoseWithCovarianceStamped& message);
  void refuseInitialPose(const std::string& problem);
  bool getLandmarks(GetLandmarks::Request& request, GetLandmarks::Response& response);
  bool saveMap(SaveMap::Request& request, SaveMap::Response& response);
  bool loadMap(LoadMap::Request& request, LoadMap::Response& response);
  bool setMode(SetMode::Request& request, SetMode::Response& response);
  /// `answer` of a request that changes the map: `body` does so and returns what it did, or throws InputError.
  template <class Response, class Body>
  bool change(const std::string& service, Response& response, const Body& body);
  bool removeLandmark(RemoveLandmark::Request& request, RemoveLandmark::Response& response);
  bool getMapUpdates(GetMapUpdates::Request& request, GetMapUpdates::Response& response);
  bool lockLandmark(LockLandmark::Request& request, LockLandmark::Response& response);
  bool addClosure(AddClosure::Request& request, AddClosure::Response& response);
  bool removeClosure(RemoveClosure::Request& request, RemoveClosure::Response& response);
  bool saveResults(SaveResults::Request& request, SaveResults::Response& response);
  void publishSlowTopics();
  NodeStatus status();
  ClockStatus clockStatus();

  ros::NodeHandle handle_;
  const SystemConfig config_;
  const ClassTable classes_;
  LiveParameters live_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_{transforms_};

  // Guarded by `slam_mutex_`.
  TicketMutex slam_mutex_;
  std::unique_ptr<Slam> slam_;
  SlamPublisher publisher_;
  OdometryGate gate_;
  SensorTransforms sensors_;
  ObjectsGate objects_gate_;
  InputPlausibility plausibility_;
  std::optional<Pose> T_odom_last_;
  bool is_localization_wanted_;
  bool is_paused_ = false;  ///< objects are dropped as they come
  bool is_loaded_;          ///< the map is from a file, and no odometry has come since
  EstimatorStatus estimator_;

  // Guarded by `status_mutex_`, which is never held for long: diagnostics go out however busy the estimator is.
  std::mutex status_mutex_;
  std::deque<UnhandledOdometry> unhandled_;
  std::optional<Stamp> handled_odometry_;  ///< the newest that the worker has used
  EstimatorStatus noted_estimator_;
  FrameTimer frame_timer_;
  TopicMonitor odometry_monitor_;
  TopicMonitor objects_monitor_;
  SequenceGaps odometry_gaps_;
  SequenceGaps objects_gaps_;

  // Of the worker, of the timer's thread, or of the spinner thread.
  ThrottledWarnings warnings_;
  std::size_t published_odometry_ = 0;  ///< guarded by `slam_mutex_`
  std::size_t published_live_ = 1;
  ros::WallTime next_trajectory_;
  ros::WallTime started_ = ros::WallTime::now();
  ros::Time last_time_;
  ros::WallTime last_time_change_ = ros::WallTime::now();

  FailureGuard input_failures_;
  FailureGuard other_failures_;
  InputQueue queue_;
  ros::Subscriber odometry_subscriber_;
  ros::Subscriber objects_subscriber_;
  ros::Subscriber fixes_subscriber_;
  ros::Subscriber initial_pose_subscriber_;
  std::vector<ros::ServiceServer> services_;
  ros::CallbackQueue service_queue_;
  ros::AsyncSpinner service_spinner_{1, &service_queue_};
  std::atomic<bool> is_closing_{false};
  ros::WallTimer pose_timer_;
  ros::CallbackQueue slow_queue_;  ///< of a thread of its own, so that no message waits for a long trajectory
  ros::AsyncSpinner slow_spinner_{1, &slow_queue_};
  ros::WallTimer slow_timer_;
  std::unique_ptr<NodeDiagnostics> diagnostics_;
  std::thread worker_;
};

template <class Response, class Body>
bool SlamNode::answer(const std::string& service, Response& response, const Body& body) {
  if (!other_failures_.run(service, body)) {
    response.success = false;
    response.message = "unexpected failure of " + other_failures_.status().newest;
  }
  return true;
}

/// The node with the parameters of a private handle. A relative `class_table` is looked up in `config_folder` first.
/// Throws InputError or ConfigError for parameters that cannot be used.
std::unique_ptr<SlamNode> makeSlamNode(const ros::NodeHandle& handle, const ros::NodeHandle& private_handle,
                                       const std::string& config_folder);

}  // namespace semantic_mht_slam
